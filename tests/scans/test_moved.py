from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from bladecad.curves.sides import split_sides
from bladecad.data.synthetic import synthetic_blade
from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.deviation.nearest.project import project
from bladecad.fit.blade import BladeFit, Order
from bladecad.fit.judge import Bench, judge
from bladecad.fit.order import fit_blade
from bladecad.scans.blade_frame import blade_frame
from bladecad.scans.fitting.moved_whole import moved_whole
from bladecad.scans.fitting.whole import WholeFit
from bladecad.scans.moved import moved_points, moved_sections, moved_surface
from bladecad.surface.blade import BladeSurface
from bladecad.surface.loft import SIDES

U, T = np.linspace(0.0, 1.0, 9), np.linspace(0.0, 1.0, 41)
STACKING = np.array([1.0, 0.0, 0.0])


@cache
def fitted() -> BladeFit:
    return fit_blade(split_sides(synthetic_blade(5, 80)), tolerance=0.05, order=Order(2, 2, 9))


@cache
def surface() -> BladeSurface:
    fit = fitted()
    return BladeSurface(fit.lines.span, fit.suction, fit.pressure)


def motion(seed=0):
    move = np.eye(4)
    move[:3, :3] = Rotation.random(random_state=seed).as_matrix()
    move[:3, 3] = np.random.default_rng(seed).normal(0.0, 50.0, 3)
    return move


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("side", SIDES)
def test_a_surface_moves_as_its_points_do(seed: int, side):
    move = motion(seed)
    after = moved_surface(surface(), move)(side, U, T).reshape(-1, 3)
    before = moved_points(surface()(side, U, T).reshape(-1, 3), move)
    np.testing.assert_allclose(after, before, atol=1e-9)


def test_a_fit_moves_with_its_lines_its_points_and_their_feet():
    rng, move = np.random.default_rng(2), motion()
    points = surface()("suction", U, T).reshape(-1, 3) + rng.normal(0.0, 0.05, (len(U) * len(T), 3))
    feet = project(nominal_of(surface()), points)
    whole = WholeFit(fitted(), surface(), points, feet, np.ones(len(points)), 0.01, 1.0, 0.0, "", 1)
    moved = moved_whole(whole, move)
    again = project(nominal_of(moved.surface), moved.points)
    np.testing.assert_allclose(moved.feet.foot, again.foot, atol=1e-6)
    np.testing.assert_allclose(moved.feet.normal, again.normal, atol=1e-6)
    np.testing.assert_allclose(moved.feet.distance, again.distance, atol=1e-9)
    errors = judge(Bench.of(moved.fit.lines), moved.fit.suction, moved.fit.pressure)
    np.testing.assert_allclose(errors.suction.rms, fitted().errors.suction.rms, atol=1e-9)


def test_sections_move_and_tell_their_machine_axis():
    move = motion()
    before = synthetic_blade(5, 80)
    after = moved_sections(before, move, "x")
    assert after.source.axis == "x"
    for one, other in zip(before.sections, after.sections, strict=True):
        np.testing.assert_allclose(moved_points(one.points, move), other.points)


@pytest.mark.parametrize("seed", range(4))
def test_the_frame_of_the_blade_does_not_depend_on_the_pose(seed: int):
    move = motion(seed)
    posed, axis = moved_surface(surface(), move), move[:3, :3] @ STACKING
    one = moved_surface(surface(), blade_frame(surface(), STACKING))
    other = moved_surface(posed, blade_frame(posed, axis))
    for side in SIDES:
        np.testing.assert_allclose(one(side, U, T), other(side, U, T), atol=1e-9)


def test_the_frame_has_the_blade_upright_and_its_chord_along_x():
    move = blade_frame(surface(), STACKING)
    assert np.linalg.det(move[:3, :3]) == pytest.approx(1.0)
    blade = moved_surface(surface(), move)
    hub = {side: blade(side, np.zeros(1), T)[0] for side in SIDES}
    chord = hub["suction"][-1] - hub["suction"][0]
    assert chord[0] > 0.0
    assert abs(chord[1]) < 1e-9
    loop = np.concatenate([hub["suction"], hub["pressure"][::-1]])
    x, y, z = loop.T
    cross = x * np.roll(y, -1) - np.roll(x, -1) * y
    for c in (x, y):
        assert np.sum((c + np.roll(c, -1)) * cross) / 3.0 / cross.sum() == pytest.approx(
            0.0, abs=0.02
        )
    assert abs(z.mean()) < 0.02
    assert blade("suction", np.ones(1), T)[0, :, 2].min() > 50.0
