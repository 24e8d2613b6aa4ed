from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from bladecad.arrays import Points
from bladecad.curves.outline import trace
from bladecad.curves.sides import split_sides
from bladecad.data.profile import Profile
from bladecad.data.sections import Sections
from bladecad.data.synthetic import profiles, synthetic_blade
from bladecad.errors import DataError
from tests.curves.blades import each

EDGES = np.array([0.0, 1.0])


def found(blade: Sections) -> Points:
    """Leading and trailing edge of every section, (m, 2, 3)."""
    return np.array([track(EDGES) for track in split_sides(blade, le="low").suction])


def exact(profile: Profile, surface: str) -> Points:
    x, y, z = profile.place(profile.outline(np.pi * EDGES)).T
    if surface == "plane":
        return np.column_stack([x, y, z])
    return np.column_stack([x * np.cos(y / x), x * np.sin(y / x), z])


@pytest.mark.parametrize("surface", ["plane", "cylinder"])
@pytest.mark.parametrize("points", [80, 240])
def test_round_edges_are_found_within_five_micrometres(surface: str, points: int):
    edges = found(synthetic_blade(5, points, surface=surface))
    truth = np.array([exact(profile, surface) for profile in profiles(5)])
    assert np.linalg.norm(edges - truth, axis=2).max() < 5e-3


def test_edges_said_by_the_file_are_the_points_themselves():
    blade = synthetic_blade(3, 60, tagged=True)
    edges = found(blade)
    for section, (le, te) in zip(blade.sections, edges, strict=True):
        np.testing.assert_allclose(le, section.points[section.le[0]], atol=1e-9)
        np.testing.assert_allclose(te, section.points[section.te[0]], atol=1e-9)


def test_edges_do_not_depend_on_where_the_loop_starts():
    blade = synthetic_blade(3, 90)
    for start in (1, 23, 45, 89):
        turned = each(blade, lambda s, k=start: replace(s, points=np.roll(s.points, k, axis=0)))
        np.testing.assert_allclose(found(turned), found(blade), atol=1e-4)


def test_edges_do_not_depend_on_the_direction_of_the_loop():
    blade = synthetic_blade(3, 90)
    back = each(blade, lambda s: replace(s, points=s.points[::-1]))
    np.testing.assert_allclose(found(back), found(blade), atol=1e-4)


def test_edges_turn_and_shift_with_the_blade_about_its_axis():
    blade = synthetic_blade(3, 90, surface="cylinder")
    turn = Rotation.from_euler("z", 0.7).as_matrix()
    moved = each(blade, lambda s: replace(s, points=s.points @ turn.T + [0, 0, 31.0]))
    np.testing.assert_allclose(found(moved), found(blade) @ turn.T + [0, 0, 31.0], atol=1e-6)


def test_edges_grow_with_the_blade():
    blade = synthetic_blade(3, 90)
    large = each(blade, lambda s: replace(s, points=7.0 * s.points))
    np.testing.assert_allclose(found(large), 7.0 * found(blade), atol=1e-5)


def test_a_cut_off_edge_ends_the_sides_at_its_two_corners():
    blade = synthetic_blade(3, 100, trailing_edge="blunt")
    lines = split_sides(blade)
    assert (lines.le, lines.te) == ("round", "blunt")
    for k, section in enumerate(blade.sections):
        ends = [side[k](np.array([1.0]))[0] for side in (lines.suction, lines.pressure)]
        corners = section.points[[0, -1]]
        assert min(
            np.abs(ends - corners).max(), np.abs(ends - corners[::-1]).max()
        ) == pytest.approx(0, abs=1e-9)


def test_a_cut_off_edge_is_found_on_a_loop_that_starts_anywhere():
    blade = synthetic_blade(3, 100, trailing_edge="blunt")
    plain = split_sides(blade)
    for start in (20, 50):
        rolled = each(
            blade, lambda s, k=start: replace(s, points=np.roll(s.points, k, axis=0), closed=True)
        )
        lines = split_sides(rolled)
        assert lines.te == "blunt"
        np.testing.assert_allclose(lines.lengths, plain.lengths, rtol=1e-9)


def test_points_set_aside_do_not_bend_the_line():
    blade = synthetic_blade(2, 120)
    section = blade.sections[0]
    points = section.points.copy()
    points[30] += [0, 0, 1.0]
    keep = np.arange(120) != 30
    good, bent = trace(section, 2), trace(replace(section, points=points), 2, keep=keep)
    lengths = [[track.length for track in outline.sides] for outline in (good, bent)]
    np.testing.assert_allclose(lengths[1], lengths[0], rtol=1e-4)


def test_three_corners_are_no_airfoil():
    corner = 60 * np.pi / 180 * np.array([0, 2, 4])
    triangle = np.column_stack([np.cos(corner), np.sin(corner)])
    fractions = np.linspace(0, 1, 20, endpoint=False)[:, None]
    sides = [
        a + fractions * (b - a) for a, b in zip(triangle, np.roll(triangle, -1, 0), strict=True)
    ]
    loop = 30 * np.vstack(sides)
    section = replace(
        synthetic_blade(1, 60).sections[0], points=np.column_stack([0 * loop[:, 0] + 100, loop])
    )
    with pytest.raises(DataError, match=r'section "1": 3 corners, at points .* two edges are'):
        trace(section, 2)
