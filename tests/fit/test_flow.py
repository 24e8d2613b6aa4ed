import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from bladecad.errors import DataError
from bladecad.fit.flow import Flow, evaluate, propagator, response, trajectory_rk4

fields = arrays(np.float64, (4, 4), elements=st.floats(-3, 3))
times = st.floats(0, 1)

SPIRAL = Flow(
    A=np.array([[-0.4, 2.0, 0.1], [-2.0, -0.3, 0.5], [0.2, 0.0, 0.7]]),
    C=np.eye(3),
    z0=np.array([10.0, 2.0, -5.0]),
)


@given(fields, times, times)
def test_the_flow_is_a_group(A, s, t):
    P = propagator(A, np.array([s, t, s + t]))
    scale = np.linalg.norm(P[0]) * np.linalg.norm(P[1])
    np.testing.assert_allclose(P[2], P[0] @ P[1], atol=1e-12 * scale)


@given(fields, times)
def test_the_determinant_of_the_flow_is_the_exponential_of_the_trace(A, t):
    P = propagator(A, np.array([t]))[0]
    volume = np.prod(np.maximum(np.linalg.norm(P, axis=0), 1.0))  # Hadamard's bound on |det P|
    np.testing.assert_allclose(np.linalg.det(P), np.exp(t * np.trace(A)), atol=1e-12 * volume)


def test_the_curve_starts_at_its_start_and_takes_t_in_any_order():
    t = np.array([0.9, 0.0, 0.01, 0.5])
    x = evaluate(SPIRAL, t)
    np.testing.assert_allclose(x[1], SPIRAL.C @ SPIRAL.z0)
    np.testing.assert_allclose(x[::-1], evaluate(SPIRAL, t[::-1]), rtol=1e-14)


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_each_derivative_is_the_central_difference_of_the_one_before(order):
    t, h = np.linspace(0, 1, 7), 1e-5
    before = (evaluate(SPIRAL, t + h, order - 1) - evaluate(SPIRAL, t - h, order - 1)) / (2 * h)
    np.testing.assert_allclose(evaluate(SPIRAL, t, order), before, rtol=1e-7, atol=1e-6)


@given(arrays(np.float64, 3, elements=st.floats(-9, 9)), times)
def test_the_curve_is_linear_in_its_start(z0, t):
    at = np.array([t])
    expected = evaluate(Flow(SPIRAL.A, SPIRAL.C, z0), at, 1)
    np.testing.assert_allclose(response(SPIRAL.A, SPIRAL.C, at, 1) @ z0, expected, atol=1e-12)


def test_runge_kutta_converges_to_the_exponential_with_order_four():
    t = np.array([0.0, 0.3, 0.45, 1.0])
    exact = evaluate(SPIRAL, t)
    errors = [np.abs(trajectory_rk4(SPIRAL, t, n) - exact).max() for n in (2, 4, 8, 16, 32)]
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    np.testing.assert_allclose(orders[-2:], 4.0, atol=0.1)


def test_a_nilpotent_field_gives_the_polynomial():
    flow = Flow(np.diag([1.0, 1.0], k=1), np.eye(3), np.array([1.0, 2.0, 6.0]))
    t = np.linspace(0, 1, 5)
    np.testing.assert_allclose(evaluate(flow, t)[:, 0], 1 + 2 * t + 3 * t**2, rtol=1e-14)
    np.testing.assert_allclose(evaluate(flow, t, 3), 0.0)


def test_growth_beyond_the_floats_is_infinite_and_no_warning():
    flow = Flow(np.eye(3) * 2000.0, np.eye(3), np.ones(3))
    assert not np.isfinite(evaluate(flow, np.array([1.0]))).any()


def test_a_flow_is_checked_and_read_only():
    with pytest.raises(DataError, match=r"Flow\.A has shape"):
        Flow(np.eye(2), np.eye(3), np.ones(3))
    with pytest.raises(ValueError, match="read-only"):
        SPIRAL.A[0, 0] = 1.0
