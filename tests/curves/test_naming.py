from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from bladecad.curves.sides import BladeLines, split_sides
from bladecad.data.read import read_sections
from bladecad.data.sections import Row, Sections
from bladecad.data.synthetic import synthetic_blade
from tests.curves.blades import each

ENDS = np.array([0.0, 1.0])


def leading(lines: BladeLines) -> np.ndarray:
    return np.array([track(ENDS)[0] for track in lines.suction])


def middle(lines: BladeLines, side: str) -> np.ndarray:
    return lines.sample(side, np.array([0.5]))[:, 0]


def mirrored(blade: Sections) -> Sections:
    """The blade of a machine that turns the other way."""
    return each(blade, lambda s: replace(s, points=s.points * [1, -1, 1]))


def test_sides_and_edges_said_by_the_file_are_taken_without_a_note():
    lines = split_sides(synthetic_blade(3, 60, tagged=True))
    assert lines.notes == ()


def test_what_is_guessed_is_what_the_file_would_have_said():
    told = split_sides(synthetic_blade(3, 60, tagged=True))
    guessed = split_sides(synthetic_blade(3, 60), le="low")
    np.testing.assert_allclose(middle(guessed, "suction"), middle(told, "suction"), atol=1e-2)
    (note,) = guessed.notes
    assert "convex side was taken as suction side" in note


@pytest.mark.parametrize("surface", ["plane", "cylinder"])
def test_the_hand_in_the_note_gives_the_same_blade_when_asked_for(surface: str):
    blade = synthetic_blade(3, 60, surface=surface)
    guessed = split_sides(blade, le="low")
    hand = guessed.notes[0].split("taken: ")[1].split(",")[0]
    other = {"left": "right", "right": "left"}[hand]
    same, swapped = (split_sides(blade, le="low", suction=h) for h in (hand, other))
    np.testing.assert_array_equal(middle(same, "suction"), middle(guessed, "suction"))
    np.testing.assert_array_equal(middle(swapped, "suction"), middle(guessed, "pressure"))


def test_left_and_right_mean_the_same_on_planes_and_cylinders():
    hands = {
        surface: split_sides(synthetic_blade(3, 60, surface=surface), le="low").notes[0]
        for surface in ("plane", "cylinder")
    }
    assert hands["plane"] == hands["cylinder"]


def test_a_mirrored_blade_has_its_suction_side_on_the_other_hand():
    blade = synthetic_blade(3, 60)
    lines, turned = split_sides(blade, le="low"), split_sides(mirrored(blade), le="low")
    assert lines.notes != turned.notes
    np.testing.assert_allclose(
        middle(turned, "suction"), middle(lines, "suction") * [1, -1, 1], atol=1e-3
    )


def test_the_asked_edge_leads():
    blade = synthetic_blade(3, 60)
    low, high = (split_sides(blade, le=lead) for lead in ("low", "high"))
    assert (leading(low)[:, 2] < leading(high)[:, 2]).all()


def test_the_flow_along_the_hub_tells_the_leading_edge():
    z = np.linspace(-50, 50, 20)
    hub = np.column_stack([z, np.full(20, 170.0)])
    blade = synthetic_blade(3, 60)
    forth = split_sides(replace(blade, row=Row(hub=hub)))
    back = split_sides(replace(blade, row=Row(hub=hub[::-1])))
    np.testing.assert_allclose(
        leading(forth), [track(ENDS)[1] for track in back.suction], atol=1e-6
    )
    assert not any("--le" in note for note in forth.notes)


def test_a_round_edge_leads_a_cut_off_one():
    blade = synthetic_blade(3, 100, trailing_edge="blunt")
    lines = split_sides(blade)
    assert lines.te == "blunt"
    assert any("round edge was taken as the leading edge" in note for note in lines.notes)


def test_swapped_sides_in_one_section_are_put_right_with_a_note(fixtures: Path):
    good, swapped = (
        split_sides(read_sections(fixtures / "broken" / f"{name}_sides.csv"))
        for name in ("good", "swapped")
    )
    assert swapped.notes == (
        'section "2": suction and pressure side were swapped against the other sections; put right',
    )
    np.testing.assert_allclose(middle(swapped, "suction"), middle(good, "suction"), atol=1e-6)
