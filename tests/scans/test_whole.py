"""Surfaces fitted to all points of made-up scans, against the truth."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.deviation.nearest.project import project
from bladecad.errors import DataError
from bladecad.fit.joint import edge_conditions
from bladecad.pipeline.scan import build_scan
from bladecad.scans.finding.airfoil import find_airfoil
from bladecad.scans.fitting.neighbours import Scatter
from bladecad.scans.fitting.whole import fit_scan
from bladecad.scans.slicing.parted import parted
from bladecad.scans.slicing.slices import slice_airfoil
from bladecad.surface.loft import SIDES, graded
from tests.scans.truth import OUTLIER, scan_of, truth_surface

HOLE = ("suction", 0.4, 0.5, 0.3, 0.5)


def fitted(scan, tolerance=0.01):
    """The whole chain from points to surface."""
    airfoil = find_airfoil(scan)
    lines = parted(airfoil, slice_airfoil(airfoil))[1]
    return airfoil, fit_scan(airfoil.points, lines, airfoil.axis, tolerance=tolerance)


@pytest.fixture(scope="module", params=[("rotor37", 3), ("synthetic-thick", 4)], ids=lambda p: p[0])
def asked(request):
    """500,000 points, 10 um, 0.5 % outliers, a hole, any pose."""
    name, seed = request.param
    scan = scan_of(
        truth_surface(name), 500_000, sigma=0.01, outliers=0.005, hole=HOLE, pose="any", seed=seed
    )
    airfoil, whole = fitted(scan.scan)
    return scan, airfoil, whole, scan.distance(whole.surface)


def test_the_body_is_within_a_micrometre(asked):
    found = asked[3]
    assert found.rms() <= 0.001
    assert found.rms(found.body) <= 0.001


def test_no_place_of_the_body_is_off_by_more_than_six_micrometres(asked):
    found = asked[3]
    assert found.largest(found.body) <= 0.006


def test_the_edges_are_within_three_micrometres(asked):
    found = asked[3]
    assert found.rms(found.le) <= 0.003
    assert found.rms(found.te) <= 0.003


def test_nothing_but_noise_is_left(asked):
    scan, _, whole, _ = asked
    assert whole.noise == pytest.approx(scan.sigma, rel=0.02)
    assert abs(whole.excess - 1.0) < 0.02
    assert whole.correlation < 0.01


def test_outliers_have_no_weight_and_good_points_have(asked):
    """Six sigmas are 60 um: what stands off by more is no part, nine in ten of the rest is."""
    scan, airfoil, whole, _ = asked
    outlier = scan.kind[airfoil.taken] == OUTLIER
    far = np.abs(whole.feet.distance) > 6.5 * scan.sigma
    assert (whole.weight[outlier & far] == 0.0).all()
    assert (outlier & far).sum() > 100  # most of them stand alone, and were left out before
    assert (whole.weight[~outlier & ~whole.feet.rim] > 0.1).mean() > 0.999


def test_the_flows_are_joined_at_the_edges_everywhere(asked):
    surface = asked[2].surface
    u = np.linspace(0.0, 1.0, 41)
    for end in (0.0, 1.0):
        t = np.array([end])
        for order, sign in ((0, 1.0), (1, -1.0), (2, 1.0)):
            S, P = (surface(s, u, t, 0, order)[:, 0] for s in SIDES)
            size = np.linalg.norm(S, axis=1).max()
            assert np.abs(S - sign * P).max() < 1e-9 * size
    B = edge_conditions(surface.suction.bases[0], surface.pressure.bases[0], surface.le, surface.te)
    assert len(B) == 6


def test_half_of_the_points_give_the_same_surface():
    """Half of them at random, and every fourth: within 2 um, the noise of a fit aside."""
    scan = scan_of(truth_surface("synthetic-thick"), 400_000, sigma=0.01, pose="any", seed=8)
    airfoil, whole = fitted(scan.scan)
    lines = whole.fit.lines
    keep = np.random.default_rng(1).random(len(airfoil.points)) < 0.5
    nominal, t = nominal_of(whole.surface), graded(201)
    for points in (airfoil.points[keep], airfoil.points[::4]):
        less = fit_scan(points, lines, airfoil.axis, tolerance=0.01)
        X = np.concatenate(
            [less.surface(s, np.linspace(0.01, 0.99, 61), t).reshape(-1, 3) for s in SIDES]
        )
        feet = project(nominal, X)
        d = feet.distance[~feet.rim]
        assert np.sqrt(np.mean(d**2)) <= 0.002


@pytest.mark.parametrize("sigma", [0.002, 0.005, 0.02, 0.05])
def test_the_noise_is_told_within_ten_percent(sigma):
    scan = scan_of(truth_surface("synthetic-thick"), 120_000, sigma=sigma, outliers=0.005, seed=2)
    _, whole = fitted(scan.scan)
    assert whole.noise == pytest.approx(sigma, rel=0.1)


def test_a_clean_scan_is_followed_closer_than_it_is_asked():
    scan = scan_of(truth_surface("synthetic-thick"), 120_000, seed=5)
    _, whole = fitted(scan.scan)
    assert scan.distance(whole.surface).largest() < 0.005


@pytest.mark.parametrize("name", ["synthetic", "hannover"])
@pytest.mark.parametrize("turn", range(2))
def test_a_scan_may_lie_anywhere_also_round_the_origin(name, turn):
    """The axes of its frame then run through the blade, which has no machine about it."""
    blade, R = truth_surface(name), Rotation.random(random_state=turn).as_matrix()
    middle = blade("suction", np.array([0.5]), np.array([0.5]))[0, 0]
    scan = scan_of(blade, 40_000, sigma=0.005, pose=(R, -R @ middle), seed=turn)
    _, whole = fitted(scan.scan)
    assert scan.distance(whole.surface).rms() <= 0.001


def test_exact_points_ask_for_no_spans_that_fold_the_edges():
    """The finer surfaces through them do: the finest that does not is taken."""
    scan = scan_of(truth_surface("rotor37"), 80_000, pose="any", seed=5)
    _, whole = fitted(scan.scan)
    assert scan.distance(whole.surface).rms() < 0.005


def test_a_mesh_that_does_not_hold_the_edges_is_refused_with_what_to_do(tmp_path):
    """Edges of 0.2 mm, vertices 2 mm apart: what lies between them is anybody's guess."""
    scan = scan_of(truth_surface("rotor37"), 3_000, sigma=0.003, pose="any", seed=1, mesh=True)
    with pytest.raises(DataError, match=r"^coarse.stl: .* do not hold the edges .* finer mesh$"):
        build_scan(scan.write(tmp_path / "coarse.stl"))


@pytest.mark.parametrize("lack", [0.1, 1.0, 10.0])
def test_lack_of_fit_is_told_from_correlation_however_large(lack):
    """A residual is lack + noise, so neighbours correlate by l^2 / (l^2 + s^2)."""
    found = Scatter(1.0, 1.0, lack**2 / (lack**2 + 1.0))
    assert found.lack == pytest.approx(lack**2)


def test_too_few_points_are_refused_with_their_number():
    scan = scan_of(truth_surface("synthetic-thick"), 60_000, sigma=0.005, seed=5)
    airfoil, whole = fitted(scan.scan)
    with pytest.raises(DataError, match=r"500 points are on the airfoil, \d+ are needed"):
        fit_scan(airfoil.points[:500], whole.fit.lines, airfoil.axis, tolerance=0.01)
