"""The made-up scans are what they say: else nothing measured against them counts."""

from __future__ import annotations

import numpy as np
import pytest

from bladecad.data.synthetic import profiles
from bladecad.deviation.nearest.project import project
from bladecad.surface.blade import normals
from tests.scans.root import Root
from tests.scans.truth import (
    AIRFOIL,
    ANALYTIC,
    EDGE,
    OUTLIER,
    inside,
    nominal_for,
    scan_of,
    truth_surface,
)

HOLE = ("suction", 0.4, 0.6, 0.3, 0.5)


@pytest.fixture(scope="module")
def blade():
    return truth_surface("synthetic")


def airfoil_feet(scan):
    on = scan.kind == AIRFOIL
    return on, project(nominal_for(scan.surface), scan.to_truth(scan.points[on]))


def test_the_blade_in_closed_form_is_the_synthetic_one(blade):
    phi = blade._angle(np.linspace(0.0, 1.0, 200))
    for u, design in zip((0.0, 0.5, 1.0), profiles(3), strict=True):
        exact = design.place(design.outline(phi))
        np.testing.assert_allclose(
            blade("suction", np.array([u]), np.linspace(0.0, 1.0, 200))[0], exact, atol=1e-7
        )


@pytest.mark.parametrize("name", ANALYTIC)
def test_its_sides_meet_smoothly_and_its_derivatives_are_those_of_its_places(name):
    blade, u = truth_surface(name), np.linspace(0.0, 1.0, 5)
    for end in (0.0, 1.0):
        S, P = (blade(s, u, np.array([end])) for s in ("suction", "pressure"))
        np.testing.assert_allclose(S, P, atol=1e-9)
        S, P = (blade(s, u, np.array([end]), 0, 1) for s in ("suction", "pressure"))
        np.testing.assert_allclose(S, -P, rtol=1e-6, atol=1e-6)
    t, h = np.linspace(0.01, 0.99, 9), 1e-6
    ahead, behind = (blade("pressure", u, t + e) for e in (h, -h))
    np.testing.assert_allclose(
        blade("pressure", u, t, 0, 1), (ahead - behind) / (2 * h), rtol=1e-4, atol=1e-3
    )


@pytest.mark.parametrize("mesh", [False, True])
@pytest.mark.parametrize("root", [None, Root(), Root(end="revolution")])
def test_points_stand_off_the_truth_by_the_noise_alone(blade, root, mesh):
    scan = scan_of(
        blade, 30_000, sigma=0.01, outliers=0.005, hole=HOLE, pose="any", root=root, mesh=mesh
    )
    on, feet = airfoil_feet(scan)
    feet_in = ~feet.rim
    assert abs(feet.distance[feet_in].std() - 0.01) < 0.0003
    np.testing.assert_allclose(feet.u[feet_in], scan.u[on][feet_in], atol=1e-5)
    np.testing.assert_array_equal(inside(HOLE, feet.suction, feet.u, feet.t).any(), False)
    assert abs((scan.kind == OUTLIER).sum() / on.sum() - 0.005) < 0.001
    if root is not None:
        heights = scan.stand.height(scan.to_truth(scan.points[on]))
        assert heights.min() > scan.stand.fillet - 0.1


def test_points_lie_evenly_over_the_area(blade):
    scan = scan_of(blade, 200_000)
    u, t = np.linspace(0.0, 1.0, 9), np.linspace(0.0, 1.0, 9)
    fine = np.linspace(0.0, 1.0, 401)
    for name, on in (("suction", scan.suction), ("pressure", ~scan.suction)):
        count = np.histogram2d(scan.u[on], scan.t[on], (u, t))[0]
        middle = 0.5 * (fine[1:] + fine[:-1])
        n = np.cross(blade(name, middle, middle, 1, 0), blade(name, middle, middle, 0, 1))
        area = np.linalg.norm(n, axis=2).reshape(8, 50, 8, 50).sum(axis=(1, 3))
        expected = area / area.sum() * on.sum()
        assert np.abs((count - expected) / np.sqrt(expected)).max() < 5.0


def test_edges_are_thinned_out_as_asked(blade):
    full, thin = (scan_of(blade, 100_000, edges=e) for e in (1.0, 0.25))
    near = [int((np.minimum(s.t, 1 - s.t) < EDGE).sum()) for s in (full, thin)]
    assert abs(near[1] / near[0] - 0.25) < 0.03


@pytest.mark.parametrize("end", ["flat", "revolution"])
def test_a_mesh_is_one_shut_skin_with_its_root_below(blade, end):
    import trimesh

    scan = scan_of(blade, 8_000, root=Root(end=end), tip=True, mesh=True, pose="any")
    mesh = trimesh.Trimesh(scan.points, scan.triangles)
    assert mesh.is_winding_consistent
    assert mesh.volume > 0
    along = scan.points @ scan.axis
    assert along[scan.kind == AIRFOIL].mean() > along[scan.kind == 1].mean() + 30.0


def test_a_blade_is_no_distance_from_itself_and_an_offset_one_is(blade):
    scan = scan_of(blade, 2_000, pose="any", hole=HOLE, root=True)
    R, shift = scan.pose

    class Moved:
        def __call__(self, name, u, t, du=0, dt=0):
            X = blade(name, 0.01 + 0.98 * u, t, du, dt)
            X = X if du + dt else X + self.off * normals(blade, name, 0.01 + 0.98 * u, t)
            return X @ R.T if du + dt else X @ R.T + shift

        off = 0.0

    found = scan.distance(Moved())
    assert found.largest() < 1e-7
    assert 0.03 < found.left_out < 0.1
    assert not inside(HOLE, found.suction, found.u, found.t)[found.counts].any()
    assert found.le.any()
    assert found.te.any()
    assert (found.le | found.te | found.body).sum() == found.counts.sum()
    Moved.off = 0.01
    found = scan.distance(Moved())
    np.testing.assert_allclose(found.normal[found.counts], 0.01, atol=1e-5)
    assert abs(found.rms(found.le) - 0.01) < 1e-5
