from dataclasses import replace
from itertools import permutations
from pathlib import Path

import numpy as np
import pytest

from bladecad.curves.develop import cylindrical
from bladecad.curves.repair import heights, repaired
from bladecad.data.read import read_sections
from bladecad.data.sections import Section, Sections
from bladecad.data.synthetic import synthetic_blade
from bladecad.errors import DataError
from tests.curves.blades import PUBLISHED, with_section

BLADE = synthetic_blade(5, 80)


def names(blade: Sections) -> list[str]:
    return [section.name for section in blade.sections]


def reordered(blade: Sections, order: tuple[int, ...]) -> Sections:
    return replace(blade, sections=tuple(blade.sections[i] for i in order))


def turned(section: Section, axial: float, tangential: float) -> np.ndarray:
    """The section with its axial and angular coordinates mirrored about their means."""
    z, r, theta = cylindrical(section.points, 2)
    z, theta = (v.mean() + sign * (v - v.mean()) for v, sign in ((z, axial), (theta, tangential)))
    return np.column_stack([r * np.cos(theta), r * np.sin(theta), z])


def test_a_good_blade_passes_unchanged():
    assert repaired(BLADE).sections == BLADE.sections
    assert repaired(BLADE).source.notes == ()


@pytest.mark.parametrize("name", PUBLISHED)
def test_published_blades_keep_their_order(shared_data: Path, name: str):
    blade = read_sections(shared_data / PUBLISHED[name])
    mended = repaired(blade)
    assert mended.sections == blade.sections
    assert mended.source.notes == blade.source.notes


def test_a_section_out_of_order_is_put_where_it_belongs(fixtures: Path):
    mended = repaired(read_sections(fixtures / "broken" / "out_of_order.csv"))
    assert names(mended) == ["1", "2", "3", "4"]
    assert mended.source.notes == (
        'out of order along the span: section "3"; sorted by mean radius',
    )


def test_sections_in_any_order_are_sorted():
    small = replace(BLADE, sections=BLADE.sections[:4])
    for order in permutations(range(4)):
        mended = repaired(reordered(small, order))
        assert names(mended) == names(small)
        assert bool(mended.source.notes) == (order != (0, 1, 2, 3))


def test_a_blade_from_tip_to_hub_is_turned_round():
    mended = repaired(reordered(BLADE, (4, 3, 2, 1, 0)))
    assert names(mended) == names(BLADE)
    assert mended.source.notes == ("the sections ran from tip to hub; turned round",)


def test_sections_of_one_radius_are_ordered_along_the_stacking_line():
    """As on the vanes of a radial diffuser, which stand between two discs."""
    disc = [
        replace(s, points=s.points[:, [1, 2, 0]] * [1, 1, 0] + [0, 260, 10 * k])
        for k, s in enumerate(synthetic_blade(1, 60).sections * 3)
    ]
    blade = replace(BLADE, sections=tuple(replace(s, name=f"{k}") for k, s in enumerate(disc)))
    assert heights(blade)[1] == "place along the stacking line"
    assert names(repaired(reordered(blade, (0, 2, 1)))) in (["0", "1", "2"], ["2", "1", "0"])


def test_two_sections_at_one_place_are_refused():
    twice = replace(BLADE, sections=(*BLADE.sections, replace(BLADE.sections[2], name="copy")))
    with pytest.raises(DataError, match=r'sections "3" and "copy" lie 0 mm apart .* leave one'):
        repaired(twice)


def test_a_section_that_runs_backwards_is_noted(fixtures: Path):
    mended = repaired(read_sections(fixtures / "broken" / "flipped_section.csv"))
    assert mended.source.notes == ('runs the other way round than most: section "2"; put right',)


@pytest.mark.parametrize(
    ("axial", "tangential", "how", "k"),
    [
        (-1, -1, "turned by 180 degrees", 0),
        (-1, -1, "turned by 180 degrees", 2),
        (1, -1, "mirrored in the tangential direction", 0),
        (1, -1, "mirrored in the tangential direction", 2),
        (1, -1, "mirrored in the tangential direction", 4),
        (-1, 1, "mirrored in the axial direction", 0),
    ],
)
def test_a_turned_or_mirrored_section_is_refused_by_name(axial, tangential, how, k):
    blade = synthetic_blade(5, 80, surface="cylinder")
    bad = with_section(blade, k, turned(blade.sections[k], axial, tangential))
    with pytest.raises(DataError, match=f'section "{k + 1}": {how} against the sections beside'):
        repaired(bad)


def test_a_loop_that_crosses_itself_is_refused_with_the_place(fixtures: Path):
    with pytest.raises(
        DataError,
        match=r'section "2": the outline crosses itself between points 20-21 and 30-31, near '
        r"\(203.333, 12.263, 11.550\) mm",
    ):
        repaired(read_sections(fixtures / "broken" / "self_crossing.csv"))


@pytest.mark.parametrize("start", range(2, 75, 9))
def test_two_points_in_the_wrong_order_cross_the_outline(start: int):
    points = BLADE.sections[1].points.copy()
    points[[start, start + 2]] = points[[start + 2, start]]
    with pytest.raises(DataError, match="crosses itself"):
        repaired(with_section(BLADE, 1, points))


def test_a_gap_is_refused_with_its_size_and_place(fixtures: Path):
    with pytest.raises(
        DataError,
        match=r'section "2": a gap of 36.7 mm between points 12 and 13, near \(203.333, -11.866, '
        r"-11.952\) mm, 32% of the perimeter and 12 times",
    ):
        repaired(read_sections(fixtures / "broken" / "gap.csv"))


def test_the_seam_of_a_closed_loop_may_not_be_a_gap_either():
    points = np.roll(BLADE.sections[1].points, -28, axis=0)[:-9]
    with pytest.raises(DataError, match=r"a gap of .* between points 71 and 1,"):
        repaired(with_section(BLADE, 1, points))


@pytest.mark.parametrize(
    ("factor", "why"), [(25.4, "as in are to mm"), (0.1, "as mm are to cm"), (3.1, "times that")]
)
def test_a_section_of_another_size_is_refused(factor: float, why: str):
    bad = with_section(BLADE, 2, factor * BLADE.sections[2].points)
    with pytest.raises(DataError, match=f'section "3" is .* mm large, .*{why}'):
        repaired(bad)
