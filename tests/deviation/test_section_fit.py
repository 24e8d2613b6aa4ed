"""Two-dimensional fits: what was moved is found back, and nothing fits better than the best."""

import numpy as np
import pytest
from scipy.optimize import minimize

from bladecad.data.profile import Profile
from bladecad.deviation.sectioning.outline_curve import OutlineCurve
from bladecad.deviation.sectioning.section_fit import Limits, fit_section, fits_of
from bladecad.errors import DataError, ToleranceError
from bladecad.tolerance import Band

PROFILE = Profile(height=200.0, length=50.0, turning=0.5, thickness=3.0)
KINDS = ("least squares", "min-max", "leading edge", "trailing edge")
WIDE = Limits(Band(-9, 9), Band(-9, 9), Band(-20, 20))


def loop(count):
    """Outline and outward normals, crowded at the edges; suction side up, edges at both ends."""
    x = np.linspace(0.0, 2 * np.pi, count, endpoint=False)
    phi = x - 0.3 * np.sin(2 * x)
    h = 1e-6
    T = (PROFILE.outline(phi + h) - PROFILE.outline(phi - h)) / (2 * h)
    n = np.column_stack([-T[:, 1], T[:, 0]])
    return PROFILE.outline(phi), n / np.linalg.norm(n, axis=1, keepdims=True)


@pytest.fixture(scope="module")
def section():
    return loop(400)


def turned(X, angle):
    c, s = np.cos(angle), np.sin(angle)
    return X @ np.array([[c, s], [-s, c]])


def measured(section, shift, twist, bump=None):
    """Deviation along the nominal normals of an outline that was moved about its centre."""
    outline, normals = section
    curve = OutlineCurve(outline, normals)
    centre = np.average(outline, axis=0, weights=curve.length)
    X = outline if bump is None else outline + bump[:, None] * normals
    there = turned(X - centre, twist) + centre + shift
    feet = OutlineCurve(there, turned(normals, twist))
    low, high = -np.ones(len(outline)), np.ones(len(outline))
    for _ in range(45):  # along each normal, by halving: the first outline it meets
        middle = 0.5 * (low + high)
        outside = feet.foot(outline + middle[:, None] * normals)[0] > 0
        low, high = np.where(outside, low, middle), np.where(outside, middle, high)
    return 0.5 * (low + high)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    ("shift", "twist"),
    [((0.01, -0.02), 0.0), ((0.0, 0.0), 2e-3), ((-0.03, 0.05), -1e-3), ((0.1, 0.15), 3e-3)],
)
def test_a_section_moved_by_a_shift_and_a_twist_is_found_back(section, kind, shift, twist):
    d = measured(section, shift, twist)
    found = fit_section(*section, d, kind=kind)
    np.testing.assert_allclose(found.shift, shift, atol=2e-6)
    assert found.twist == pytest.approx(twist, abs=1e-7)
    assert np.abs(found.residual).max() < 2e-6
    assert max(np.abs(found.after)) < 1e-3 * max(np.abs(found.before))


def test_feet_on_the_outline_are_nearest_of_a_dense_search(section):
    curve = OutlineCurve(*section)
    rng = np.random.default_rng(1)
    outline, normals = section
    k = rng.integers(0, len(outline), 100)
    q = outline[k] + rng.uniform(-0.1, 1.0, 100)[:, None] * normals[k]
    distance, normal = curve.foot(q)
    dense = curve(np.linspace(0.0, len(outline), 20_000))
    nearest = np.array([np.linalg.norm(dense - p, axis=1).min() for p in q])
    step = np.linalg.norm(np.diff(dense, axis=0), axis=1).max()
    assert (np.abs(distance) <= nearest + 1e-12).all()
    assert (nearest <= np.hypot(distance, step)).all()
    np.testing.assert_allclose(curve.foot(q - distance[:, None] * normal)[0], 0.0, atol=1e-9)


def suction(outline):
    """The first half of the loop."""
    return np.arange(len(outline)) < len(outline) // 2


def wavy(section, size=0.02):
    outline, _ = section
    x = outline[:, 0] / np.ptp(outline[:, 0])
    up = np.where(suction(outline), 1.0, -1.0)
    return size * (np.sin(9 * x + 1.0) + 0.4 * up * np.cos(23 * x) + 0.3 * up)


def test_no_motion_leaves_less_than_each_fit_does(section):
    """Each fit against a search without derivatives over the exact residuals."""
    d = measured(section, (0.02, 0.03), 1e-3, wavy(section))
    curve = OutlineCurve(*section)
    weight = curve.length / curve.length.sum()
    metal = section[0] + d[:, None] * section[1]
    for kind, size in (
        ("least squares", lambda r: np.sqrt(weight @ r**2)),
        ("min-max", lambda r: np.abs(r).max()),
    ):
        found = fit_section(*section, d, kind=kind)

        def left(g, found=found, size=size):
            back = turned(metal - found.centre - g[:2], -g[2] / 20) + found.centre
            return size(curve.foot(back)[0])

        mine = left([*found.shift, 20 * found.twist])
        assert mine == pytest.approx(size(found.residual), rel=1e-9)
        for start in ((0, 0, 0), (*found.shift, 20 * found.twist)):
            other = minimize(left, start, method="Nelder-Mead", options={"maxiter": 90})
            assert mine <= other.fun * (1 + 1e-6)


def test_min_max_is_level_at_four_points_of_either_sign_and_below_least_squares(section):
    d = measured(section, (0.02, 0.03), 1e-3, wavy(section))
    least, level = (fit_section(*section, d, kind=k) for k in ("least squares", "min-max"))
    top = np.abs(level.residual).max()
    assert top < 0.98 * np.abs(least.residual).max()
    assert level.after[2] > least.after[2]
    active = np.abs(level.residual) > top * (1 - 1e-3)
    assert active.sum() >= 4  # three unknowns and the level itself
    assert set(np.sign(level.residual[active])) == {-1.0, 1.0}
    assert level.after[:2] == pytest.approx((-top, top), rel=1e-6)


def test_a_constrained_fit_stays_within_its_limits_and_is_free_when_they_are_wide(section):
    d = measured(section, (0.02, 0.05), 2e-3, wavy(section, 0.005))
    free = fit_section(*section, d)
    wide = fit_section(*section, d, kind="constrained", limits=WIDE)
    np.testing.assert_allclose(wide.shift, free.shift, atol=1e-7)
    assert wide.twist == pytest.approx(free.twist, abs=1e-8)
    limits = Limits(Band(-0.5, 0.5), Band(-0.01, 0.03), Band(-0.05, 0.05))
    held = fit_section(*section, d, kind="constrained", limits=limits)
    assert -0.5 <= held.shift[0] <= 0.5
    assert held.shift[1] == pytest.approx(0.03, abs=1e-9)
    assert np.degrees(held.twist) == pytest.approx(0.05, abs=1e-9)
    assert free.after[2] < held.after[2] < held.before[2]


def test_an_edge_fit_looks_at_its_edge_alone(section):
    """A bump elsewhere changes nothing; least squares is drawn by it."""
    outline, _ = section
    x = outline[:, 0] / np.ptp(outline[:, 0])
    bump = 0.1 * np.exp(-(((x - 0.5) / 0.1) ** 2)) * suction(outline)
    for kind in ("leading edge", "trailing edge"):
        clean = fit_section(*section, measured(section, (0.02, 0.03), 1e-3), kind=kind)
        with_bump = fit_section(*section, measured(section, (0.02, 0.03), 1e-3, bump), kind=kind)
        np.testing.assert_allclose(with_bump.shift, clean.shift, atol=1e-6)
        assert np.nanmax(with_bump.residual) > 0.05
    drawn = fit_section(*section, measured(section, (0.02, 0.03), 1e-3, bump))
    assert drawn.shift[1] > 0.035


def test_turning_the_plane_turns_the_shift_and_keeps_the_rest(section):
    d = measured(section, (0.02, 0.03), 1e-3, wavy(section))
    R = 0.7
    here = fit_section(*section, d)
    there = fit_section(turned(section[0], R) - np.ones(2), turned(section[1], R), d)
    np.testing.assert_allclose(there.shift, turned(here.shift, R), atol=1e-9)
    assert there.twist == pytest.approx(here.twist, abs=1e-11)
    np.testing.assert_allclose(there.residual, here.residual, atol=1e-9)


def test_a_loop_told_the_other_way_round_fits_the_same(section):
    d = measured(section, (0.02, 0.03), 1e-3, wavy(section))
    here = fit_section(*section, d)
    there = fit_section(section[0][::-1], section[1][::-1], d[::-1])
    np.testing.assert_allclose(there.shift, here.shift, atol=1e-9)
    np.testing.assert_allclose(there.residual[::-1], here.residual, atol=1e-9)


def test_places_that_were_not_measured_neither_pull_nor_stop_the_fit(section):
    d = measured(section, (0.02, 0.03), 1e-3)
    d[100:180] = np.nan
    found = fit_section(*section, d)
    np.testing.assert_allclose(found.shift, (0.02, 0.03), atol=2e-6)
    assert np.isnan(found.residual[100:180]).all()
    assert found.fitted == 320


def test_all_fits_come_together_and_those_without_points_are_left_out(section):
    d = measured(section, (0.02, 0.03), 1e-3)
    assert [f.kind for f in fits_of(*section, d)] == list(KINDS)
    found = fits_of(*section, d, limits=Limits(twist=Band(-0.01, 0.01)))
    assert found[-1].kind == "constrained"
    assert np.degrees(found[-1].twist) == pytest.approx(0.01)
    d[(section[0][:, 0]) < 8.0] = np.nan
    assert "leading edge" not in [f.kind for f in fits_of(*section, d)]


def test_a_cut_off_edge_is_straight_between_its_corners():
    """A rectangle: corners are kept, and feet lie on the four straight steps."""
    x = np.array([0.0, 0.0, 10.0, 10.0])
    y = np.array([-1.0, 1.0, 1.0, -1.0])
    n = np.column_stack([np.zeros(4), y])
    curve = OutlineCurve(np.column_stack([x, y]), n)
    q = np.array([[5.0, 2.0], [12.0, 0.3], [-0.5, 0.0], [5.0, -0.7]])
    np.testing.assert_allclose(curve.foot(q)[0], [1.0, 2.0, 0.5, -0.3], atol=1e-12)


def test_too_few_points_and_missing_limits_are_refused(section):
    d = np.full(400, np.nan)
    d[200:204] = 0.01
    with pytest.raises(DataError, match=r"4 points .* least squares fit looks, 6 are needed"):
        fit_section(*section, d)
    with pytest.raises(DataError, match=r"leading edge fit"):
        fit_section(*section, d, kind="leading edge")
    with pytest.raises(ToleranceError, match="limits"):
        fit_section(*section, np.zeros(400), kind="constrained")
