"""Cutters, passes, thickness and stock of shapes on which they are known."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from bladecad.cam.balls import balls
from bladecad.cam.cutter import largest_ball, passes, spacing
from bladecad.cam.edges import edges
from bladecad.cam.places import places
from bladecad.cam.sheet import Cutting, cam_sheet
from bladecad.cam.stacking import stacking_axis
from bladecad.cam.stock import stock
from bladecad.cam.thickness import thickness
from bladecad.data.sections import Machine
from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.deviation.nearest.skin import search
from bladecad.errors import ToleranceError
from tests.cam.blades import good, tube, waisted
from tests.surface.test_shapes import lens

CONCAVE = 10.0**2 / (3.0 * (3.0 * 0.8 - 1.0))  # of the waist, a^2 / (b (3 w - 1))


def test_the_least_concave_radius_of_a_waist():
    found = places(waisted())
    assert 1.0 / -found.k2.min() == pytest.approx(CONCAVE, rel=1e-6)
    assert "t = 0.5000" in found.named(int(found.k2.argmin()))


def test_the_largest_ball_fits_the_waist_and_no_larger_one_does():
    blade = waisted()
    skin, found = nominal_of(blade).sides, places(blade)
    for leave in (1e-4, 0.01):
        radius, place = largest_ball(skin, found, leave)
        for r, fits in ((radius, True), (1.03 * radius, False)):
            deep = r - np.abs(search(skin, found.points + r * found.directions).distance)
            assert (deep.max() <= leave) == fits
        assert "side" in found.named(place)
    assert largest_ball(skin, found, 1e-6)[0] == pytest.approx(CONCAVE, rel=0.02)


def test_any_ball_reaches_a_convex_shape():
    blade = tube(10.0, 3.0)
    assert largest_ball(nominal_of(blade).sides, places(blade), 1e-3) is None


def scallop_of(width, k, R):
    """Height at which two circles about a curve of curvature k meet, found by going there."""
    if k == 0.0:
        return R - np.sqrt(R**2 - (width / 2.0) ** 2)
    rho, half = 1.0 / k, 0.5 * width * k
    centre = (rho + R) * np.array([np.sin(half), np.cos(half)])
    sign = np.sign(rho)
    return brentq(
        lambda h: np.linalg.norm(np.array([0.0, sign * abs(rho + h)]) - centre) - R, 0.0, R
    )


@pytest.mark.parametrize("k", [0.0, 0.1, 1.0, -0.05, -0.2])
def test_passes_leave_the_scallop_that_was_asked_for(k):
    width = float(spacing(np.array([k]), 3.0, 0.01)[0])
    assert scallop_of(width, k, 3.0) == pytest.approx(0.01, rel=1e-6)


def test_spacing_is_smooth_where_the_surface_is_flat():
    k = np.array([-1e-6, -1e-12, 0.0, 1e-12, 1e-6])
    np.testing.assert_allclose(spacing(k, 3.0, 0.01), 2.0 * np.sqrt(0.01 * 5.99), rtol=1e-5)


@pytest.mark.parametrize("scallop", [0.0, -1.0, 3.0, np.nan])
def test_scallops_beyond_the_ball_are_refused(scallop):
    with pytest.raises(ToleranceError, match="scallop"):
        spacing(np.zeros(1), 3.0, scallop)


def test_passes_on_a_tube_are_as_many_as_its_girth_and_height_take():
    blade, R, h = tube(10.0, 10.0, 40.0), 3.0, 0.02
    chordwise, spanwise = passes(blade, places(blade), radius=R, scallop=h)
    flat, round_ = (float(spacing(np.array([k]), R, h)[0]) for k in (0.0, 0.1))
    assert len(chordwise.at) == np.ceil(40.0 / flat) + 1
    assert len(spanwise.at) == np.ceil(10.0 * np.pi / round_) + 1
    assert chordwise.narrowest == pytest.approx(flat, rel=1e-6)
    assert spanwise.widest == pytest.approx(round_, rel=1e-6)
    assert (np.diff(chordwise.at).max() * 40.0 <= flat * (1.0 + 1e-9)).all()


def test_neighbouring_passes_of_a_blade_are_nowhere_further_apart_than_the_widest():
    blade = good()
    chordwise, _ = passes(blade, places(blade), radius=3.0, scallop=0.05)
    X = blade("suction", chordwise.at, np.linspace(0.0, 1.0, 401))
    nearest = np.min(np.linalg.norm(X[1:, :, None] - X[:-1, None, ::4], axis=3), axis=1)
    assert nearest.max() <= chordwise.widest * 1.02


def test_thickness_of_tubes_and_waists():
    round_, flat, thin = tube(10.0, 10.0), tube(10.0, 3.0), waisted()
    for blade, thinnest, thickest in ((round_, 20.0, 20.0), (flat, None, 6.0), (thin, 1.2, None)):
        found = thickness(blade, nominal_of(blade).sides, np.linspace(0.0, 1.0, 5))
        if thinnest:
            assert found.thinnest[0] == pytest.approx(thinnest, rel=1e-4)
        if thickest:
            assert found.thickest[0] == pytest.approx(thickest, rel=1e-4)
            assert found.of_sections == pytest.approx(thickest, rel=1e-4)


def test_inscribed_balls_are_empty_and_touch():
    blade = good()
    skin, found = nominal_of(blade).sides, places(blade, 9, 101)
    inner = (slice(None), slice(10, -10))
    X, n = (a[0][inner].reshape(-1, 3) for a in (found.X, found.n))
    ball = balls(skin, X, -n, np.full(len(X), 20.0))
    centre = X - ball.radius[:, None] * n
    np.testing.assert_allclose(np.abs(search(skin, centre).distance), ball.radius, atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(ball.other - centre, axis=1), ball.radius, atol=1e-6)


def test_the_stock_of_a_tube_beside_the_machine_axis():
    blade = tube(10.0, 5.0, 40.0, beside=100.0)
    found = stock(places(blade).points, stacking_axis(blade), Machine("z"))
    np.testing.assert_allclose(found.high - found.low, [20.0, 10.0, 40.0], atol=1e-9)
    assert found.bar_diameter == pytest.approx(20.0, rel=1e-6)
    assert found.bar_length == pytest.approx(40.0)
    assert found.ring == pytest.approx((90.0, 110.0))
    assert found.axial == pytest.approx((0.0, 40.0))
    tangent = 5.0 / np.sqrt(100.0**2 - 10.0**2)  # of the ellipse from the machine axis
    assert found.sector == pytest.approx(2.0 * np.arctan(tangent), rel=1e-3)


def test_the_sector_does_not_care_where_angles_begin():
    angles = np.radians([170.0, 175.0, -178.0])
    points = 50.0 * np.column_stack([np.cos(angles), np.sin(angles), 0 * angles])
    found = stock(points, stacking_axis(tube()), Machine("z"))
    assert np.degrees(found.sector) == pytest.approx(12.0)


def test_the_smallest_circle_is_that_of_all_points_tried():
    rng = np.random.default_rng(3)
    points = np.column_stack([rng.normal(size=(40, 2)), np.zeros(40)])
    found = stock(points, stacking_axis(tube()), Machine("z"))
    from scipy.optimize import minimize

    slow = minimize(lambda c: np.linalg.norm(points[:, :2] - c, axis=1).max(), [0.0, 0.0],
                    method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12})  # fmt: skip
    assert found.bar_diameter == pytest.approx(2.0 * slow.fun, rel=1e-6)


def test_edges_are_measured_as_an_inspector_does():
    u = np.linspace(0.0, 1.0, 5)
    le, te = edges(tube(10.0, 10.0, taper=0.5), u, 2)
    np.testing.assert_allclose(le.size, 10.0 * (1.0 - 0.5 * u), rtol=1e-3)
    np.testing.assert_allclose(te.size, 10.0 * (1.0 - 0.5 * u), rtol=1e-3)
    le, te = edges(lens(blunt=True), u, 2)
    np.testing.assert_allclose(te.size, 3.0 * (1.0 - 0.4 * u), rtol=1e-9)
    assert le.kind == "blunt"
    assert edges(lens(), u, 2)[0].size.max() == 0.0


def test_a_sheet_says_flank_milling_for_a_cone_and_point_milling_for_a_bow():
    cone = cam_sheet(tube(10.0, 3.0, taper=0.3))
    assert cone.flank_millable
    assert np.isinf([cone.ball.value, cone.concave.value]).all()
    bowed = cam_sheet(tube(10.0, 3.0, bow=0.3, sections=5))
    assert not bowed.flank_millable
    assert replace(bowed, cutting=Cutting(tolerance=0.3)).flank_millable
    overcut = max(3.0 * (1.0 - np.cos(0.5 * side.twist.max())) for side in bowed.flanks)
    assert bowed.flank_error == pytest.approx(0.2 + overcut, rel=0.01)


@pytest.mark.parametrize(
    "options",
    [{"ball": 0.0}, {"scallop": -1.0}, {"tolerance": np.nan}, {"ball": 1.0, "scallop": 2.0}],
)
def test_cutting_without_sense_is_refused(options):
    with pytest.raises(ToleranceError, match="give"):
        Cutting(**options)


def test_a_coarse_scallop_in_a_tight_hollow_still_has_a_spacing():
    found = spacing(np.array([-1.0, -1e3, 0.0, 1.0]), 3.0, 1.0)
    assert np.isfinite(found).all()
    assert (found > 0.0).all()
