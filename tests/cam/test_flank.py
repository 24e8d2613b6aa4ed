"""Rulings on surfaces of which the best ones are known."""

import numpy as np
import pytest

from bladecad.cam.flank import flank
from bladecad.cam.rulings import side_skin
from bladecad.cam.variant import Variant, varied
from bladecad.deviation.nearest.skin import search
from tests.cam.blades import good, tube
from tests.surface.test_shapes import lens

CHORD, HEIGHT = 30.0, 40.0


def plate(degrees):
    """A plate 3 mm thick whose tip is turned: both sides are ruled, and twisted."""
    flat = lens(chord=CHORD, thick=1e-9, height=HEIGHT, taper=0.0, blunt=True, sections=2)
    return varied(flat, Variant(untwist=degrees))


def twist_of_plate(degrees, x):
    """Angle between the normals at hub and tip of the ruling at x from the axis, y = 1.5 mm off.

    S(u) = a + u (b - a), S_x = (1 - u) e + u f with e, f the chord at hub and tip.
    """
    turn = np.radians(degrees)
    R = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1.0]])
    a = np.array([x, 1.5, 0.0])
    along = R @ a + [0.0, 0.0, HEIGHT] - a
    n = [np.cross(e, along) for e in (np.eye(3)[0], R @ np.eye(3)[0])]
    return np.arccos(n[0] @ n[1] / np.linalg.norm(n[0]) / np.linalg.norm(n[1]))


@pytest.mark.parametrize(("taper", "side"), [(0.0, "suction"), (0.5, "pressure")])
def test_cylinder_and_cone_are_ruled_and_their_normals_do_not_twist(taper, side):
    found = flank(tube(10.0, 3.0, taper=taper), side)
    assert found.largest < 1e-6
    assert found.twist.max() < 1e-4
    assert found.error(5.0) < 1e-6


def test_a_bow_leaves_two_thirds_of_its_height():
    """The best line through the parabola 4 h u (1 - u) is level, at its mean 2/3 h."""
    bow = 0.2
    found = flank(tube(10.0, 3.0, bow=bow, sections=5), "suction")
    assert found.largest == pytest.approx(2.0 / 3.0 * bow, rel=0.02)
    middle = np.abs(found.t - 0.5).argmin()
    assert abs(found.deviation[0, middle]) == pytest.approx(2.0 / 3.0 * bow, rel=0.02)
    assert found.deviation[len(found.v) // 2, middle] == pytest.approx(-bow / 3.0, rel=0.05)


@pytest.mark.parametrize(("side", "sign"), [("suction", -1.0), ("pressure", 1.0)])
def test_metal_stands_above_rulings_where_their_deviation_is_negative(side, sign):
    """A bow towards the suction side bulges there, and is hollow on the other."""
    found = flank(tube(10.0, 3.0, bow=0.2, sections=5), side)
    assert sign * found.deviation[len(found.v) // 2, 40] > 0


@pytest.mark.parametrize("degrees", [5.0, 20.0])
def test_a_twisted_plate_is_ruled_and_its_normal_twists_as_worked_out(degrees):
    found = flank(plate(degrees), "suction")
    assert found.largest < 1e-6
    x = CHORD * (found.t - 0.5)
    expected = [twist_of_plate(degrees, one) for one in x]
    np.testing.assert_allclose(found.twist, expected, atol=1e-5)


def test_a_cylinder_along_a_twisted_ruling_cuts_as_deep_as_is_told():
    """Its axis is laid over the middle of a ruling; the skin says how near it comes."""
    blade, radius = plate(10.0), 6.0
    found, skin = flank(blade, "suction"), side_skin(blade, "suction")
    t = np.array([0.5])
    a, b = blade("suction", np.array([0.0, 1.0]), t)[:, 0]
    n = search(skin, (0.5 * (a + b))[None]).normal[0]
    axis = a + np.linspace(0.0, 1.0, 201)[:, None] * (b - a) + radius * n
    deep = radius - np.abs(search(skin, axis).distance).min()
    twist = found.twist[len(found.t) // 2]
    assert radius * (1.0 - np.cos(0.5 * twist)) == pytest.approx(deep, rel=0.05)
    assert found.overcut(radius) >= deep


def test_rulings_of_a_blade_never_cross_and_beat_the_lines_of_equal_t():
    blade = good()
    found = flank(blade, "suction")
    assert (np.diff(found.ends) > 0).all()
    S = blade("suction", np.array([0.0, 1.0]), found.t)
    v = found.v[:, None, None]
    straight = (1.0 - v) * S[0] + v * S[1]
    away = search(side_skin(blade, "suction"), straight.reshape(-1, 3)).distance
    assert found.rms < np.sqrt(np.mean(away**2))


def test_a_smaller_blade_deviates_in_proportion():
    blade = good()
    first, second = (flank(b, "pressure") for b in (blade, varied(blade, Variant(scale=0.1))))
    assert second.rms == pytest.approx(0.1 * first.rms, rel=0.02)
