"""The engine against slow, obvious searches: sides, closed bodies, patches and triangles."""

import numpy as np
import pytest
import trimesh
from scipy.optimize import minimize

from bladecad.curves.sides import split_sides
from bladecad.data.synthetic import synthetic_blade
from bladecad.deviation.nearest.nominal import nominal_of, nominal_of_mesh, nominal_of_patches
from bladecad.deviation.nearest.project import OVERSHOOT, project
from bladecad.deviation.nearest.skin import CHUNK, in_chunks
from bladecad.deviation.nearest.squares import EXACT, cut
from bladecad.deviation.nearest.triangles import search_triangles, triangle_skin
from bladecad.errors import DataError, GeometryError
from bladecad.fit.blade import Order
from bladecad.pipeline import Settings, fit, surface_of
from bladecad.surface.blade import normals
from bladecad.surface.loft import graded, loft
from bladecad.surface.triangulate import triangulate

SIDES = ("suction", "pressure")


@pytest.fixture(scope="module", params=["round", "blunt"])
def surface(request):
    sections = synthetic_blade(5, 80, trailing_edge=request.param)
    return surface_of(fit(split_sides(sections), Settings(order=Order(2, 2, 9), tolerance=0.05)))


def scattered(surface, count, away, seed, margin=0.0):
    """Points off both sides, half of them next to the edges, by up to `away` mm either way."""
    rng = np.random.default_rng(seed)
    points = []
    for side in SIDES:
        u = rng.uniform(margin, 1.0 - margin, count)
        t = np.where(rng.random(count) < 0.5, rng.random(count), rng.choice(graded(4001), count))
        n = np.array([normals(surface, side, u[k : k + 1], t[k : k + 1])[0, 0]
                      for k in range(count)])  # fmt: skip
        step = n + 0.7 * rng.normal(size=(count, 3))
        step /= np.linalg.norm(step, axis=1, keepdims=True)
        points.append(surface.at(side, u, t) + rng.uniform(-away, away, (count, 1)) * step)
    return np.concatenate(points)


def brute(surface, points):
    """Distances by a dense grid on both sides, then descents from its best places."""
    u, t = np.linspace(0, 1, 161), graded(481)
    grids = {side: surface(side, u, t) for side in SIDES}
    nearest = np.full(len(points), np.inf)
    for k, point in enumerate(points):
        for side, X in grids.items():
            d = np.linalg.norm(X - point, axis=2)
            for part in np.array_split(np.arange(len(t)), 12):
                i, j = np.unravel_index(d[:, part].argmin(), (len(u), len(part)))
                if d[i, part[j]] < nearest[k] + 0.5:
                    start = u[i], t[part[j]]
                    nearest[k] = min(nearest[k], descended(surface, side, point, start))
    return nearest


def descended(surface, side, point, start):
    """Least distance by a quasi-Newton descent within the side."""

    def f(p):
        r = surface.at(side, p[:1], p[1:])[0] - point
        return r @ r, [2 * r @ surface.at(side, p[:1], p[1:], *o)[0] for o in ((1, 0), (0, 1))]

    options = {"ftol": 1e-16, "gtol": 1e-12}
    bounds = [(0, 1), (0, 1)]
    found = minimize(f, start, jac=True, bounds=bounds, method="L-BFGS-B", options=options)
    return np.sqrt(found.fun)


@pytest.mark.parametrize("away", [0.05, 5.0])
def test_distances_are_those_of_a_dense_search_refined(surface, away):
    points = scattered(surface, 6, away, seed=2)
    feet = project(nominal_of(surface), points)
    mine = np.linalg.norm(points - feet.foot, axis=1)
    slow = brute(surface, points)
    assert (mine <= slow + 1e-6).all()
    on_side = feet.face < 2
    assert np.abs(mine - slow)[on_side].max() < 1e-6
    assert feet.unsettled == 0


def test_a_closed_body_knows_inside_from_outside(surface):
    """The winding number of a fine triangulation, which shares nothing with the search."""
    points = scattered(surface, 300, 5.0, seed=4)
    feet = project(nominal_of(surface), points, caps=True)
    mesh = triangulate(surface, chord_error=0.01)
    clear = np.abs(feet.distance) > mesh.chord_error
    wound = winding(mesh.vertices, mesh.triangles, points[clear])
    assert clear.sum() > 400
    assert 10 < (wound > 0.5).sum() < len(wound) - 10
    np.testing.assert_array_equal(feet.distance[clear] < 0, wound > 0.5)


def winding(vertices, triangles, points):
    """Solid angle of all triangles over 4 pi (van Oosterom and Strackee 1983)."""
    wound = np.empty(len(points))
    for k, x in enumerate(points):
        a, b, c = np.moveaxis((vertices - x)[triangles], 1, 0)
        la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
        dot = [np.einsum("kx,kx->k", *p) for p in ((a, b), (b, c), (c, a))]
        volume = np.einsum("kx,kx->k", a, np.cross(b, c))
        angle = np.arctan2(volume, la * lb * lc + dot[0] * lc + dot[1] * la + dot[2] * lb)
        wound[k] = 2 * angle.sum() / (4 * np.pi)
    return wound


def test_offset_points_measure_their_offset_to_the_last_digits(surface):
    for side in SIDES:
        u, t = np.linspace(0.05, 0.95, 40), graded(81)[1:-1]
        t = t[t < 0.99] if surface.te == "blunt" else t
        points = (surface(side, u, t) + 0.03 * normals(surface, side, u, t)).reshape(-1, 3)
        feet = project(nominal_of(surface), points)
        assert np.abs(feet.distance - 0.03).max() < 2 * EXACT
        there = (feet.suction == (side == "suction")) & (feet.t > 0) & (feet.t < 1)
        assert there.all()
        np.testing.assert_allclose(feet.t.reshape(40, -1), np.tile(t, (40, 1)), atol=1e-8)


def test_squares_follow_the_surface_between_their_nodes(surface):
    sides = nominal_of(surface).sides.squares
    rng = np.random.default_rng(0)
    for side, face in (("suction", 0), ("pressure", 1)):
        which = rng.choice(np.flatnonzero(sides.face == face), 300)
        v, w = rng.random((2, 300))
        u0, du, t0, dt = sides.domain[which].T
        powers = v[:, None] ** np.arange(4), w[:, None] ** np.arange(8)
        X = np.einsum("ki,kj,kijx->kx", *powers, sides.c[which])
        away = np.linalg.norm(X - surface.at(side, u0 + v * du, t0 + w * dt), axis=1)
        assert away.max() < 2 * EXACT


def test_points_beyond_hub_and_tip_are_told_apart(surface):
    nominal = nominal_of(surface)
    t = np.linspace(0.2, 0.8, 7)
    for u, sense in ((np.zeros(1), -1.0), (np.ones(1), 1.0)):
        rim = surface("suction", u, t)[0]
        along = surface("suction", u, t, 1, 0)[0]
        along *= sense / np.linalg.norm(along, axis=1, keepdims=True)
        n = normals(surface, "suction", u, t)[0]
        near, far = 0.5 * OVERSHOOT * nominal.length, 5.0 * OVERSHOOT * nominal.length
        assert project(nominal, rim + far * along).rim.all()
        feet = project(nominal, rim + near * along + 0.02 * n)
        assert not feet.rim.any()
        np.testing.assert_allclose(feet.distance, 0.02, atol=1e-3 * near + 1e-9)


def test_the_order_of_the_points_does_not_matter(surface):
    points = scattered(surface, 400, 0.5, seed=8)
    order = np.random.default_rng(1).permutation(len(points))
    nominal = nominal_of(surface)
    a, b = project(nominal, points), project(nominal, points[order])
    np.testing.assert_allclose(a.distance[order], b.distance, atol=1e-11)
    assert len(project(nominal, points[:0]).distance) == 0
    one = project(nominal, points[7:8])
    np.testing.assert_allclose(one.distance, a.distance[7:8], atol=1e-11)


def test_every_point_is_searched_once_whatever_the_chunks():
    points = np.random.default_rng(0).random((1000, 3))
    seen = []

    def job(part, order, into):
        assert len(part) <= CHUNK
        np.testing.assert_array_equal(np.sort(order), np.arange(len(part)))
        into.distance[:] = part[:, 0]
        seen.append(len(part))
        return 1

    found = in_chunks(points, job)
    np.testing.assert_array_equal(found.distance, points[:, 0])
    assert found.unsettled == len(seen)
    assert sum(seen) == 1000


def test_patches_of_a_loft_measure_what_the_surface_measures(surface):
    lofted = loft(surface, tolerance=1e-3)
    patches = [("SUCTION_SIDE", lofted.suction), ("PRESSURE_SIDE", lofted.pressure)]
    points = scattered(surface, 200, 0.05, seed=6, margin=0.02)
    own, other = (
        project(n, points) for n in (nominal_of(surface), nominal_of_patches(patches, surface))
    )
    on_side = own.face < 2
    assert np.abs(own.distance - other.distance)[on_side].max() < 1e-3
    np.testing.assert_array_equal(own.suction, other.suction)


def test_triangles_measure_what_trimesh_measures(surface):
    mesh = triangulate(surface, chord_error=0.02)
    points = scattered(surface, 150, 4.0, seed=5)
    found = search_triangles(triangle_skin(mesh.vertices, mesh.triangles), points)
    body = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
    theirs = trimesh.proximity.closest_point(body, points)[1]
    np.testing.assert_allclose(np.abs(found.distance), theirs, atol=1e-9)
    inside = winding(mesh.vertices, mesh.triangles, points) > 0.5
    np.testing.assert_array_equal(found.distance < 0, inside)


def test_a_mesh_nominal_leaves_out_what_closes_it(surface):
    mesh = triangulate(surface, chord_error=0.005)
    nominal = nominal_of_mesh(mesh.vertices, mesh.triangles, surface)
    caps = len(mesh.faces["HUB"]) + len(mesh.faces["TIP"])
    assert len(nominal.other.corners) <= len(mesh.triangles) - 0.9 * caps
    points = scattered(surface, 200, 0.05, seed=9, margin=0.02)
    own = project(nominal_of(surface), points)
    there = own.face < 2
    away = np.abs(project(nominal, points).distance - own.distance)[there]
    assert away.max() < 2 * mesh.chord_error


def test_triangles_without_area_and_faces_with_kinks_are_refused():
    with pytest.raises(DataError, match="no triangle of the nominal has an area"):
        triangle_skin(np.zeros((3, 3)), np.array([[0, 1, 2]]))
    with pytest.raises(GeometryError, match="squares to follow it"):
        cut(
            lambda u, t: np.stack(
                np.broadcast_arrays(u[:, None], t[None, :], np.abs(t - 1 / 3)[None, :] ** 0.5), -1
            ),
            np.array([0.0, 1.0]), np.array([0.0, 1.0]), face=0, sign=1.0,
        )  # fmt: skip
