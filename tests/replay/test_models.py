"""The models of the ladder, on curves whose answer is known."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from bladecad.fit.blade import Order
from bladecad.fit.flow import Flow, evaluate
from bladecad.fit.samples import Samples
from bladecad.replay.curves import Curves, distance, score
from bladecad.replay.edge_modes import modal_fit, size, spectra_of, spline
from bladecad.replay.ladder import RUNGS
from bladecad.replay.quadratic import monomials, quadratic
from bladecad.replay.running import run
from bladecad.replay.subject import JUDGED
from bladecad.replay.trajectory import modes, on_trajectory

A = np.array([[-0.4, 2.0, 0.1], [-2.0, -0.3, 0.5], [0.2, 0.0, 0.7]])
AFFINE = Flow(
    np.block([[A, np.ones((3, 1))], [np.zeros((1, 4))]]), np.eye(3, 4), np.array([9.0, 2, -5, 1])
)


def stretch_of(curve, k):
    """A stretch of one line, the points of a curve at equal parameters."""
    t = np.linspace(0, 1, k)
    dense = np.linspace(0, 1, (k - 1) * JUDGED + 1)
    at, between = (curve(x)[None] for x in (t, dense))
    samples = Samples(dense, between)
    return SimpleNamespace(t=t, points=at, fitted=samples, judged=samples)


def largest(stretch, curves):
    return distance(curves.between, stretch.judged.points).max()


def test_an_affine_flow_is_found_on_its_trajectory():
    stretch = stretch_of(lambda t: evaluate(AFFINE, t), 41)
    assert largest(stretch, on_trajectory(stretch)) < 1e-3


@pytest.mark.parametrize("theta", [(1.0, 4.0, -2.0), (-3.0, -25.0, 8.0), (0.5, 0.0, 1.0)])
def test_the_modes_solve_their_linear_equation(theta):
    m, s, r = theta
    t = np.linspace(0, 1, 4001)
    y = modes(np.array([theta]), t)[0]
    one, two = (np.gradient(v, t, axis=0, edge_order=2) for v in (y, np.gradient(y, t, axis=0)))
    pair = two[9:-9, 1:3] - 2 * m * one[9:-9, 1:3] + (m * m - s) * y[9:-9, 1:3]
    assert np.abs(pair).max() < 1e-3 * max(1, abs(s))
    np.testing.assert_allclose(one[9:-9, 3], r * y[9:-9, 3], atol=1e-4)


def test_a_quadratic_field_is_followed_with_order_two():
    M = np.array(
        [
            [1.0, 0, 1, 0, 0, 0.2, 0, 0, 0, 0],
            [0.3, -1, 0, 0, 0, 0, 0, -0.3, 0, 0],
            [0.2, 0, 0, 0.5, 0.1, 0, 0, 0, 0, 0],
        ]
    )
    whole = solve_ivp(
        lambda _, y: M @ monomials(y),
        (0, 3),
        [1.0, 0.5, 0.2],
        rtol=1e-11,
        atol=1e-11,
        dense_output=True,
    ).sol
    fine = np.linspace(0, 3, 20001)
    s = np.append(0, np.cumsum(np.linalg.norm(np.diff(whole(fine).T, axis=0), axis=1)))
    errors = [
        largest(x, quadratic(x))
        for x in (
            stretch_of(lambda t: whole(np.interp(t, s / s[-1], fine)).T, k) for k in (41, 81, 161)
        )
    ]
    assert errors[-1] < 0.02
    assert errors[0] > 1.5 * errors[1] > 2 * errors[2]


@pytest.mark.parametrize("speed", [0.1, 10.0, 300.0])
def test_running_by_doubling_is_the_exponential(speed):
    flow = Flow(speed * (A - np.eye(3)), np.eye(3), np.array([1.0, 2.0, 3.0]))
    t = np.linspace(0, 1, 57)
    np.testing.assert_allclose(run(flow, t), evaluate(flow, t), atol=1e-9)


def test_a_curve_that_leaves_the_floats_is_infinitely_far():
    flow = Flow(5000.0 * np.eye(3), np.eye(3), np.ones(3))
    t = np.array([0.0, 1.0])
    assert list(np.isfinite(distance(run(flow, t), np.zeros((2, 3))))) == [True, False]


def test_a_cubic_is_its_own_spline():
    stretch = stretch_of(lambda t: np.column_stack([t, t**2, t**3 - t]), 30)
    assert largest(stretch, spline(stretch, 12)) < 1e-12


def test_refitting_the_linear_blend_is_blending_the_coefficients(results):
    side = results.subjects["full"].suction
    spectrum = spectra_of(results.subjects["full"], Order(2, 2, 7))[0]
    Phi = np.linalg.pinv(spectrum(side.fitted.t))
    X, u = side.fitted.points, 0.3
    refitted = Phi @ (u * X[4] + (1 - u) * X[5])
    blended = u * (Phi @ X[4]) + (1 - u) * (Phi @ X[5])
    np.testing.assert_allclose(spectrum(side.judged.t) @ (refitted - blended), 0.0, atol=1e-9)


def test_the_linear_law_is_the_blend_of_neighbours(results):
    surface = results.modal["linear"]
    t, span = np.linspace(0, 1, 9), surface.span
    rows = surface("suction", np.array([span[3], 0.25 * span[3] + 0.75 * span[4], span[4]]), t)
    np.testing.assert_allclose(rows[1], 0.25 * rows[0] + 0.75 * rows[2], atol=1e-9)


def test_the_sides_of_the_modal_fit_meet(results):
    suction, pressure = modal_fit(results.subjects["full"], Order(2, 2, 7))
    ends = np.array([0.0, 1.0])
    np.testing.assert_allclose(suction(ends), pressure(ends), atol=1e-7)
    np.testing.assert_allclose(suction(ends, 1), -pressure(ends, 1), atol=1e-4)


def test_a_score_counts_the_worst_line_and_the_median():
    points = np.zeros((3, 5, 3))
    stretch = SimpleNamespace(points=points, judged=SimpleNamespace(points=points))
    off = np.array([1.0, 2.0, 9.0])[:, None, None] * np.ones((3, 5, 3)) / np.sqrt(3)
    found = score((stretch,), (Curves(off, off),))
    np.testing.assert_allclose(found, (9.0, 9.0, np.sqrt(86 / 3), 2.0))


def test_b_splines_have_as_many_coefficients_as_the_modal_fits():
    assert size(Order(4, 4, 17)) == 34
    modal = [n for name, (n, _) in RUNGS.items() if "modal" in name]
    assert modal == [n for name, (n, _) in RUNGS.items() if "spline" in name]
