"""Surfaces in closed form: every derivative, curvature, volume and triangle is known."""

import itertools

import numpy as np
import pytest
import trimesh
from numpy.polynomial import Polynomial

from bladecad.errors import GeometryError
from bladecad.fit.orbit import Orbit
from bladecad.fit.sidefit import SideFit
from bladecad.fit.spectrum import Spectrum
from bladecad.surface.blade import BladeSurface, normals, outward, principal_curvatures
from bladecad.surface.loft import loft
from bladecad.surface.triangulate import triangulate
from bladecad.surface.volume import volume

NONE = np.empty((0, 2))
U, T = np.linspace(0, 1, 9), np.linspace(0.05, 0.95, 11)


def polynomial_side(x, y, z, span):
    """Curves of degree three, one a section: x, y, z are functions of (t, u)."""
    basis, t = Spectrum(3, NONE, NONE), np.linspace(0, 1, 7)
    curves = [np.column_stack([f(t, u) + 0 * t for f in (x, y, z)]) for u in span]
    return SideFit((basis,), np.array([np.linalg.solve(*square(basis(t), c)) for c in curves]))


def square(Phi, Y):
    return Phi.T @ Phi, Phi.T @ Y


def lens(*, chord=30.0, thick=0.2, height=40.0, taper=0.4, blunt=False, sections=4, law="spline"):
    """Parabolas either side of a chord, tapered along the span; a gap at both edges if blunt."""
    span, gap = np.linspace(0, 1, sections), 0.05 * blunt

    def side(sign):
        return polynomial_side(
            lambda t, u: (1 - taper * u) * chord * (t - 0.5),
            lambda t, u: sign * (1 - taper * u) * chord * (thick * t * (1 - t) + gap),
            lambda t, u: height * u,
            span,
        )

    kind = "blunt" if blunt else "sharp"
    return BladeSurface(span, side(1.0), side(-1.0), law, kind, kind)


def lens_volume(*, chord=30.0, thick=0.2, height=40.0, taper=0.4, blunt=False):
    section = chord**2 * (thick / 3 + 0.1 * blunt)
    return section * height * Polynomial([1.0, -2 * taper, taper**2]).integ()(1.0)


def cone(radius=8.0, top=3.0, height=20.0):
    """Half a cone each side, by the rotation that is a flow: no polynomial, no approximation."""
    spin = np.pi * np.array([[0.0, -1.0], [1.0, 0.0]])
    A = np.zeros((3, 3))
    A[:2, :2] = spin
    orbit = Orbit(A, np.array([1.0, 0.0, 1.0]))
    sides = []
    for sign in (1.0, -1.0):
        C = [
            np.array([[-r, 0, 0], [0, sign * r, 0], [0, 0, z]])
            for r, z in ((radius, 0.0), (top, height))
        ]
        sides.append(SideFit((orbit,), np.array(C)))
    return BladeSurface(np.array([0.0, 1.0]), sides[0], sides[1])


@pytest.mark.parametrize("law", ["spline", "linear"])
@pytest.mark.parametrize("order", list(itertools.product(range(3), range(3))))
def test_every_partial_derivative_of_a_known_polynomial_is_exact(law, order):
    du, dt = order
    px, pt = Polynomial([1.0, 2.0, -3.0, 0.5]), Polynomial([0.0, 1.0, 0.7, -2.0])
    degree_one = law == "linear"
    pu = Polynomial([2.0, -1.0]) if degree_one else Polynomial([2.0, -1.0, 3.0, 1.5])

    def term(p, v, r):
        return p.deriv(r)(v) if r else p(v)

    span = np.array([0.0, 0.2, 0.45, 0.8, 1.0])
    side = polynomial_side(
        lambda t, u: px(t) * pu(u), lambda t, u: pt(t) + 0 * u, lambda t, u: 9 * u + 0 * t, span
    )
    found = BladeSurface(span, side, side, law)("suction", U[1:-1], T, du, dt)
    u, t = U[1:-1, None], T[None, :]
    one = 1.0 if du == 0 else 0.0
    expected = np.stack(
        np.broadcast_arrays(
            term(px, t, dt) * term(pu, u, du),
            one * term(pt, t, dt) + 0 * u,
            9 * term(Polynomial([0.0, 1.0]), u, du) * (dt == 0) + 0 * t,
        ),
        axis=-1,
    )
    np.testing.assert_allclose(found, expected, atol=1e-9)


def test_the_curvatures_of_a_cone_are_zero_and_cosine_over_radius():
    radius, top, height = 8.0, 3.0, 20.0
    surface = cone(radius, top, height)
    for name in ("suction", "pressure"):
        larger, smaller = principal_curvatures(surface, name, U, T)
        r = radius + (top - radius) * U
        slant = height / np.hypot(height, radius - top)
        np.testing.assert_allclose(larger, np.broadcast_to((slant / r)[:, None], larger.shape))
        np.testing.assert_allclose(smaller, 0.0, atol=1e-9)


def test_the_curvatures_of_a_saddle_multiply_to_those_of_gauss():
    side = polynomial_side(lambda t, u: t, lambda t, u: t * u, lambda t, u: u, np.array([0.0, 1.0]))
    surface = BladeSurface(np.array([0.0, 1.0]), side, side)
    larger, smaller = principal_curvatures(surface, "suction", U, T)
    q = 1 + U[:, None] ** 2 + T[None, :] ** 2
    np.testing.assert_allclose(larger * smaller, -1 / q**2, rtol=1e-9)
    H = 0.5 * (larger + smaller)
    np.testing.assert_allclose(np.abs(H), np.abs(U[:, None] * T[None, :]) / q**1.5, atol=1e-12)


@pytest.mark.parametrize("make", [lens, cone])
def test_normals_are_unit_and_those_of_the_triangles(make):
    surface = make()
    mesh = triangulate(surface, chord_error=0.01)
    for name, face in (("suction", "SUCTION_SIDE"), ("pressure", "PRESSURE_SIDE")):
        n = normals(surface, name, mesh.u, mesh.t)
        np.testing.assert_allclose(np.linalg.norm(n, axis=2), 1.0, rtol=1e-12)
        body = trimesh.Trimesh(mesh.vertices, mesh.faces[face], process=False)
        middle = n[:-1, :-1] + n[1:, 1:] + n[:-1, 1:] + n[1:, :-1]
        middle = middle / np.linalg.norm(middle, axis=2, keepdims=True)
        cells = np.repeat(middle.reshape(-1, 3), 2, axis=0)
        assert len(cells) == len(body.faces)
        assert np.einsum("kx,kx->k", cells, body.face_normals).min() > np.cos(np.radians(12))
    assert outward(surface, "suction") == -outward(surface, "pressure")


@pytest.mark.parametrize("blunt", [False, True])
def test_the_quadrature_finds_the_volume_of_a_lens_in_closed_form(blunt):
    lofted = loft(lens(blunt=blunt), tolerance=1e-6)
    exact = lens_volume(blunt=blunt)
    assert volume(lofted.suction, lofted.pressure) == pytest.approx(exact, rel=1e-12)


def test_the_quadrature_does_not_care_where_the_blade_stands():
    lofted = loft(lens(), tolerance=1e-6)
    far = [
        type(p)(p.poles + 1e4, p.knots_u, p.knots_t, 3, 3)
        for p in (lofted.suction, lofted.pressure)
    ]
    assert volume(*far) == pytest.approx(lens_volume(), rel=1e-9)
    assert volume(*far[::-1]) == pytest.approx(lens_volume(), rel=1e-9)


@pytest.mark.parametrize("blunt", [False, True])
def test_triangles_fill_the_volume_ever_better_as_their_chord_error_falls(blunt):
    """Flat triangles between points of a smooth surface: missing volume is of its order."""
    exact = lens_volume(blunt=blunt)
    missing = []
    for chord_error in (0.08, 0.02, 0.005, 0.00125):
        mesh = triangulate(lens(blunt=blunt), chord_error=chord_error)
        body = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
        assert body.volume == pytest.approx(mesh.volume, rel=1e-12)
        missing.append(1 - mesh.volume / exact)
    ratios = np.divide(missing[:-1], missing[1:])
    np.testing.assert_allclose(ratios, 4.0, rtol=0.45)
    assert 0 < missing[-1] < 1e-3


def test_the_volume_asked_for_is_reached_to_one_in_ten_thousand():
    exact = lens_volume()
    mesh = triangulate(lens(), chord_error=0.1, volume=exact)
    assert mesh.volume == pytest.approx(exact, rel=1e-4)


@pytest.mark.parametrize("chord_error", [0.1, 0.02, 0.004])
@pytest.mark.parametrize("make", [lens, cone])
def test_no_place_of_the_surface_is_further_from_the_triangles_than_they_say(make, chord_error):
    surface = make()
    mesh = triangulate(surface, chord_error=chord_error)
    assert mesh.chord_error <= chord_error
    body = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
    rng = np.random.default_rng(0)
    for name in ("suction", "pressure"):
        places = surface.at(name, rng.random(400), rng.random(400))
        away = trimesh.proximity.closest_point(body, places)[1]
        assert away.max() <= chord_error
        assert away.max() <= 1.01 * mesh.chord_error  # said from the middles of edges and triangles


def shared(a, b):
    return np.intersect1d(np.unique(a), np.unique(b))


@pytest.mark.parametrize("blunt", [False, True])
def test_faces_are_closed_wound_alike_and_share_their_border_by_number(blunt):
    mesh = triangulate(lens(blunt=blunt), chord_error=0.01)
    body = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
    assert body.is_watertight
    assert body.is_winding_consistent
    assert body.euler_number == 2
    assert body.volume > 0
    assert ("LEADING_EDGE" in mesh.faces) == ("TRAILING_EDGE" in mesh.faces) == blunt
    assert len(np.unique(mesh.vertices, axis=0)) == len(mesh.vertices)
    assert (body.area_faces > 0).all()
    n, m = len(mesh.t), len(mesh.u)
    for side in ("SUCTION_SIDE", "PRESSURE_SIDE"):
        for end in ("HUB", "TIP"):
            assert len(shared(mesh.faces[side], mesh.faces[end])) == n
        for edge in ("LEADING_EDGE", "TRAILING_EDGE") if blunt else ():
            assert len(shared(mesh.faces[side], mesh.faces[edge])) == m
    both = shared(mesh.faces["SUCTION_SIDE"], mesh.faces["PRESSURE_SIDE"])
    assert len(both) == (0 if blunt else 2 * m)


def test_a_chord_error_that_takes_millions_of_triangles_is_refused():
    with pytest.raises(GeometryError, match="takes more than 4,000,000 triangles"):
        triangulate(cone(), chord_error=1e-10)


def test_a_polynomial_surface_is_lofted_exactly_with_the_first_knots():
    surface = lens()
    lofted = loft(surface, tolerance=1e-9)
    for name, patch in (("suction", lofted.suction), ("pressure", lofted.pressure)):
        for du, dt in ((0, 0), (1, 0), (0, 1), (1, 1), (0, 2)):
            away = patch(U, T, du, dt) - surface(name, U, T, du, dt)
            assert np.abs(away).max() < 1e-7


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-6])
def test_the_loft_of_a_cone_keeps_what_is_asked_and_its_ends_exactly(tolerance):
    surface = cone()
    lofted = loft(surface, tolerance=tolerance)
    u, t = np.linspace(0, 1, 33), np.sort(np.random.default_rng(1).random(2000))
    for name, patch in (("suction", lofted.suction), ("pressure", lofted.pressure)):
        away = np.linalg.norm(patch(u, t) - surface(name, u, t), axis=2).max()
        assert away <= tolerance
        ends = np.array([0.0, 1.0])
        for r in range(3):
            apart = np.abs(patch(u, ends, 0, r) - surface(name, u, ends, 0, r)).max()
            assert apart < 1e-9 * 10.0 ** (2 * r)


def test_the_error_of_the_loft_falls_with_the_fourth_power_of_its_spans():
    lofts = [loft(cone(), tolerance=e) for e in (1e-3, 1e-5, 1e-7)]
    spans = [len(np.unique(x.suction.knots_t)) - 1 for x in lofts]
    errors = [x.error for x in lofts]
    orders = -np.diff(np.log(errors)) / np.diff(np.log(spans))
    assert (orders > 3.5).all()


def test_a_loft_out_of_reach_is_refused_with_numbers():
    with pytest.raises(GeometryError, match="um from the surface with 600 spans"):
        loft(cone(), tolerance=1e-13)
