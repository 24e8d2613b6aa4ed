import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.linalg import expm

from bladecad.errors import DataError
from bladecad.fit.flow import Flow, evaluate
from bladecad.fit.orbit import Orbit

fields = arrays(np.float64, (4, 4), elements=st.floats(-8, 8))
starts = arrays(np.float64, 4, elements=st.floats(-9, 9))
times = st.floats(0, 1)


@given(fields, starts, times, st.integers(0, 3))
def test_the_orbit_is_the_matrix_exponential_of_the_start(A, z0, t, order):
    orbit = Orbit(A, z0)
    expected = np.linalg.matrix_power(A, order) @ expm(A * t) @ z0
    norm = np.linalg.norm(A, 2)
    scale = 1.0 + np.exp(norm * t) * max(norm, 1.0) ** order * np.linalg.norm(z0)
    np.testing.assert_allclose(orbit(np.array([t]), order)[0], expected, atol=1e-12 * scale)


@given(fields, starts)
def test_the_derivative_is_the_field_applied(A, z0):
    t = np.linspace(0, 1, 23)
    z, rate = Orbit(A, z0)(t), Orbit(A, z0)(t, 1)
    scale = 1.0 + np.abs(z) @ np.abs(A).T
    np.testing.assert_allclose(rate / scale, z @ A.T / scale, atol=1e-11)


def test_a_stiff_orbit_is_as_right_as_a_calm_one():
    A = np.array([[-3000.0, 1000.0, 0.0], [-1000.0, -3000.0, 2.0], [0.0, 0.0, -0.5]])
    t, z0 = np.linspace(0, 1, 37), np.array([1.0, 2.0, 3.0])
    exact = evaluate(Flow(A, np.eye(3), z0), t)
    np.testing.assert_allclose(Orbit(A, z0)(t), exact, atol=1e-11)


def test_times_come_in_any_order_and_the_start_is_the_start():
    orbit = Orbit(np.array([[0.0, 2.0], [-2.0, 0.1]]), np.array([1.0, 0.0]))
    t = np.array([0.9, 0.0, 0.33])
    np.testing.assert_array_equal(orbit(t)[::-1], orbit(t[::-1]))
    np.testing.assert_array_equal(orbit(t)[1], orbit.z0)
    assert orbit.size == 2


def test_growth_beyond_the_floats_is_not_finite_and_no_warning():
    orbit = Orbit(np.diag([3000.0, 0.0]), np.ones(2))
    assert not np.isfinite(orbit(np.array([1.0]))).all()


def test_field_and_start_must_fit():
    with pytest.raises(DataError, match=r"Orbit\.A has shape"):
        Orbit(np.eye(3), np.ones(2))
