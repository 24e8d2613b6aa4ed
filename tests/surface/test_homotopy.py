import numpy as np
import pytest
from scipy.linalg import expm
from threadpoolctl import threadpool_limits

from bladecad.curves.sides import split_sides
from bladecad.data.synthetic import synthetic_blade
from bladecad.fit.blade import Order
from bladecad.fit.joint import solve_joint
from bladecad.fit.modal import prepare
from bladecad.fit.order import fit_blade
from bladecad.fit.samples import Samples
from bladecad.fit.sidefit import SideFit
from bladecad.fit.spectrum import Spectrum
from bladecad.pipeline import surface_of
from bladecad.surface.between import leave_one_out
from bladecad.surface.blade import BladeSurface, normals
from bladecad.surface.homotopy import flow_at
from bladecad.surface.loft import graded

SIDES = ("suction", "pressure")
LAWS = ("linear", "spline")
T = np.linspace(0, 1, 101)
U = np.linspace(0, 1, 41)


@pytest.fixture(scope="module")
def lines():
    return split_sides(synthetic_blade(5, 100, tagged=True))


@pytest.fixture(scope="module")
def fit(lines):
    with threadpool_limits(1):
        return fit_blade(lines, tolerance=0.01, order=Order(2, 2, 9))


@pytest.fixture(scope="module", params=LAWS)
def surface(request, fit):
    return surface_of(fit, request.param)


def refit(fit, lines, weights):
    """Blend the samples of all sections and fit the blend with the same spectra."""
    data = prepare(lines)
    blended = tuple(
        Samples(s.t, np.einsum("i,itx->tx", weights, s.points)[None]) for s in data.samples
    )
    spectra = (fit.suction.bases[0], fit.pressure.bases[0])
    return solve_joint(spectra, blended, lines.le, lines.te)


@pytest.mark.parametrize("u", [0.0, 0.2, 0.55, 0.83, 1.0])
def test_blending_the_data_and_refitting_is_blending_the_coefficients(fit, lines, surface, u):
    weights = surface.blend(np.array([u]))[0]
    again = refit(fit, lines, weights)
    for name in SIDES:
        mine = np.einsum("i,inx->nx", weights, surface.side(name).coefficients)
        theirs = getattr(again, name)[0]
        scale = np.abs(mine).max()
        np.testing.assert_allclose(theirs / scale, mine / scale, atol=1e-9)
        curve = surface(name, np.array([u]), T)[0]
        np.testing.assert_allclose(surface.side(name).bases[0](T) @ theirs, curve, atol=1e-8)


def test_the_flow_at_a_span_reproduces_the_surface_by_its_matrix_exponential(surface):
    for name in SIDES:
        flow = flow_at(surface, name, 0.37)
        curve = surface(name, np.array([0.37]), np.array([0.0, 0.02, 0.05]))[0]
        for t, point in zip((0.0, 0.02, 0.05), curve, strict=True):
            np.testing.assert_allclose(flow.C @ expm(flow.A * t) @ flow.z0, point, atol=1e-7)


def test_the_laws_are_cardinal_and_sum_to_one(surface):
    np.testing.assert_allclose(surface.blend(surface.span), np.eye(5), atol=1e-12)
    np.testing.assert_allclose(surface.blend(U).sum(axis=1), 1.0, rtol=1e-12)
    np.testing.assert_allclose(surface.blend(U, 1).sum(axis=1), 0.0, atol=1e-10)


def test_the_linear_law_is_the_papers_blend_of_neighbours(fit, lines):
    surface, span = surface_of(fit, "linear"), lines.span
    for i in range(len(span) - 1):
        share = np.array([0.25, 0.5, 0.9])
        u = span[i] + share * (span[i + 1] - span[i])
        for name in SIDES:
            a, b = (surface(name, span[k : k + 1], T) for k in (i, i + 1))
            blend = (1 - share)[:, None, None] * a + share[:, None, None] * b
            np.testing.assert_allclose(surface(name, u, T), blend, atol=1e-10)


def test_the_spline_is_twice_differentiable_across_sections_and_the_paper_leaves_a_crease(fit):
    h = 1e-9
    for law in LAWS:
        surface = surface_of(fit, law)
        inner = surface.span[1:-1]
        for order in (0, 1, 2):
            after, before = (surface("suction", inner + s * h, T, order, 0) for s in (1, -1))
            jump, size = np.abs(after - before).max(), np.abs(after).max()
            if law == "spline" or order == 0:
                assert jump < 1e-5 * max(size, 1.0)
            elif order == 1:
                assert jump > 1e-3 * size


def test_the_spline_law_reproduces_cubics_and_the_linear_law_lines(lines):
    span = lines.span
    for law, power in (("spline", 3), ("linear", 1)):
        constant = SideFit((Spectrum(0, np.empty((0, 2)), np.empty((0, 2))),), np.zeros((5, 1, 3)))
        np.testing.assert_allclose(
            BladeSurface(span, constant, constant, law).blend(U) @ span**power, U**power, atol=1e-12
        )


def angle(a, b):
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b), axis=-1), np.sum(a * b, axis=-1)))


@pytest.mark.parametrize("end", [0.0, 1.0])
def test_the_sides_meet_without_a_corner_between_sections_too(surface, end):
    """0.1 degrees are asked; measured below 1e-6."""
    u, t = np.linspace(0, 1, 401), np.array([end])
    if surface.law == "linear":
        u = np.setdiff1d(u, surface.span)
    S, P = (surface(s, u, t)[:, 0] for s in SIDES)
    assert np.abs(S - P).max() < 1e-9
    n = []
    for s, sign in zip(SIDES, (1.0, -1.0), strict=True):
        n.append(sign * np.cross(surface(s, u, t, 1, 0)[:, 0], surface(s, u, t, 0, 1)[:, 0]))
    assert angle(n[0], n[1]).max() < 1e-6
    bend = [surface(s, u, t, 0, 2)[:, 0] for s in SIDES]
    assert np.abs(bend[0] - bend[1]).max() < 1e-7 * np.abs(bend[0]).max()


def test_a_varying_spectrum_blends_curves_and_not_coefficients(lines):
    """Its coefficients are not unique; a blend of them would be wild between sections."""
    with threadpool_limits(1):
        fit = fit_blade(lines, tolerance=0.01, order=Order(2, 2, 7), spectrum="varying")
    surface = surface_of(fit)
    u = np.array([0.31])
    expected = np.einsum("i,itx->tx", surface.blend(u)[0], surface.suction(T))
    np.testing.assert_allclose(surface("suction", u, T)[0], expected, atol=1e-12)
    shared = surface_of(fit_shared(lines))
    assert np.abs(surface("suction", U, T) - shared("suction", U, T)).max() < 0.05


def fit_shared(lines):
    with threadpool_limits(1):
        return fit_blade(lines, tolerance=0.01, order=Order(2, 2, 9))


def cubic_in_span(surface, span, jump=0.0):
    """Sections that lie on a cubic in u; the middle one may be displaced."""

    def grown(side):
        first, second, third = side.coefficients[[0, 2, 4]]
        u = span[:, None, None]
        C = first + u * (second - first) + u**3 * (third - second)
        C[len(span) // 2] += jump * side.bases[0].one[:, None] * [1.0, 1.0, 1.0]
        return SideFit(side.bases, C)

    return BladeSurface(span, grown(surface.suction), grown(surface.pressure))


def test_a_section_left_out_of_a_cubic_family_is_foretold(fit):
    span = np.array([0.0, 0.1, 0.3, 0.45, 0.7, 0.8, 1.0])
    found = leave_one_out(cubic_in_span(surface_of(fit), span))
    assert np.isnan(found[[0, -1]]).all()
    assert np.nanmax(found) < 1e-8


def test_what_a_section_is_displaced_by_shows_in_full_when_it_is_left_out(fit):
    span = np.linspace(0, 1, 7)
    displaced = cubic_in_span(surface_of(fit), span, jump=0.1)
    n = [normals(displaced, s, span[3:4], graded(201))[0] for s in SIDES]
    across = max(np.abs(0.1 * v.sum(axis=1)).max() for v in n)
    assert leave_one_out(displaced)[3] == pytest.approx(across, rel=1e-9)


def test_what_is_left_out_of_a_smooth_family_shrinks_with_the_fourth_power_of_the_section_spacing():
    errors = []
    for sections in (5, 9, 17):
        with threadpool_limits(1):
            fit = fit_blade(
                split_sides(synthetic_blade(sections, 80, tagged=True)),
                tolerance=0.05, order=Order(1, 1, 7),
            )  # fmt: skip
        found = leave_one_out(surface_of(fit))
        errors.append(np.nanmedian(found))
    assert (np.log2(np.divide(errors[:-1], errors[1:])) > 3.0).all()
