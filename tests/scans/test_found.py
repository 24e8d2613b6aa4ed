"""The airfoil found in scans, made up and real, and what is no blade refused."""

from __future__ import annotations

import numpy as np
import pytest

from bladecad.data.read_scan import read_scan
from bladecad.data.scan import Scan
from bladecad.data.sections import Source
from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.deviation.nearest.project import project
from bladecad.errors import DataError
from bladecad.scans.finding.airfoil import find_airfoil
from bladecad.scans.slicing.parted import parted
from bladecad.scans.slicing.slices import slice_airfoil
from tests.scans.truth import AIRFOIL, FOOT, SHARED, scan_of, truth_surface

TURBINE = SHARED / "scan-turbine-blade" / "turbineblade.ply"
RNG = np.random.default_rng(0)


def cloud(points):
    return Scan(points, None, Source(None, "made up"))


def on_sphere():
    x = RNG.standard_normal((40_000, 3))
    return 20.0 * x / np.linalg.norm(x, axis=1, keepdims=True)


def on_cube():
    x = RNG.uniform(-1.0, 1.0, (40_000, 3))
    k = RNG.integers(0, 3, len(x))
    x[np.arange(len(x)), k] = np.sign(x[np.arange(len(x)), k])
    return 20.0 * x


def on_plane():
    return np.column_stack([RNG.uniform(-30, 30, 40_000), RNG.uniform(-20, 20, 40_000),
                            0.01 * RNG.standard_normal(40_000)])  # fmt: skip


def on_blob():
    """Bumps on a sphere, like a small animal."""
    x = on_sphere() / 20.0
    lobes = np.array([[0.9, 0.3, 0.2], [-0.5, 0.8, 0.1], [0.2, -0.4, 0.9], [-0.6, -0.5, -0.6]])
    r = 15.0 + sum(9.0 * np.exp(-6.0 * ((x - c) ** 2).sum(axis=1)) for c in lobes)
    return x * r[:, None]


def two_blades():
    points = scan_of(truth_surface("synthetic-thick"), 30_000, sigma=0.01, seed=1).points
    return np.concatenate([points, points + np.array([0.0, 25.0, 8.0])])


def suction_side_alone():
    scan = scan_of(truth_surface("synthetic-thick"), 60_000, sigma=0.01, seed=1)
    return scan.points[scan.suction == 1]


@pytest.mark.parametrize(
    "points", [on_sphere, on_cube, on_plane, on_blob, two_blades, suction_side_alone],
    ids=lambda f: f.__name__,
)  # fmt: skip
def test_what_is_no_single_blade_is_refused(points):
    with pytest.raises(DataError, match=r"blade|airfoil|closed|loop"):
        find_airfoil(cloud(points()))


@pytest.mark.skipif(not TURBINE.exists(), reason="../shared/data is not there")
def test_the_airfoil_of_the_real_scan_is_found_within_half_a_millimetre():
    """SOURCE.md: airfoil from z = 121.5, above platform and fillet, to 148.86, cut flat."""
    scan = read_scan(TURBINE)
    found = find_airfoil(scan)
    z = found.points[:, 2]
    assert abs(np.quantile(z, 0.001) - 121.5) < 0.5
    assert abs(np.quantile(z, 0.999) - 148.9) < 0.5
    assert found.axis[2] > 0.998


@pytest.mark.parametrize("name", ["synthetic", "synthetic-thick", "synthetic-small"])
@pytest.mark.parametrize("root", [False, True], ids=["alone", "rooted"])
def test_airfoil_is_taken_and_nothing_else(name, root):
    scan = scan_of(
        truth_surface(name), 80_000, sigma=0.01, outliers=0.005, pose="any", root=root, seed=6
    )
    found = find_airfoil(scan.scan)
    assert found.axis @ scan.axis > np.cos(np.radians(6.0))
    of_airfoil = scan.kind == AIRFOIL
    assert not (found.taken & (scan.kind == FOOT)).sum() > 0.002 * found.taken.sum()
    assert (found.taken & of_airfoil).sum() > 0.8 * of_airfoil.sum()


@pytest.mark.parametrize("mesh", [False, True], ids=["cloud", "mesh"])
def test_slices_are_good_to_fifty_micrometres_edges_and_all(mesh):
    truth = truth_surface("synthetic-thick")
    scan = scan_of(truth, 80_000, sigma=0.01, pose="any", mesh=mesh, seed=7)
    found = find_airfoil(scan.scan)
    sections, lines = parted(found, slice_airfoil(found))
    assert len(lines.names) == 21
    X = np.concatenate([section.points for section in sections.sections[1:-1]])
    feet = project(nominal_of(truth), scan.to_truth(X))
    assert np.sqrt(np.mean(feet.distance**2)) < 0.02
    assert np.abs(feet.distance).max() < 0.1


def test_a_span_is_taken_as_said():
    scan = scan_of(truth_surface("synthetic-thick"), 40_000, sigma=0.005, seed=3)
    whole = find_airfoil(scan.scan)
    low, high = whole.low + 10.0, whole.high - 15.0
    part = find_airfoil(scan.scan, axis=whole.axis, span=(low, high))
    heights = part.height(part.points)
    assert low <= heights.min() < low + 0.5
    assert high - 0.5 < heights.max() <= high
