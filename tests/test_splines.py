import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import BSpline, make_interp_spline

from bladecad.splines import basis, clamped, not_a_knot

degrees = st.integers(0, 5)


@st.composite
def knot_vectors(draw):
    """Degree and full knot vector; inner knots up to `degree` fold."""
    degree = draw(degrees)
    gaps = draw(st.lists(st.floats(0.05, 1.0), min_size=1, max_size=6))
    breaks = np.cumsum([draw(st.floats(-3, 3)), *gaps])
    repeats = [draw(st.integers(1, max(degree, 1))) for _ in breaks[1:-1]]
    return degree, np.repeat(breaks, [degree + 1, *repeats, degree + 1])


def places(knots, count=41):
    return np.linspace(knots[0], knots[-1], count)


@given(knot_vectors())
def test_b_splines_are_a_partition_of_unity_and_nowhere_negative(drawn):
    degree, knots = drawn
    N = basis(knots, degree, places(knots))
    assert N.shape[1] == len(knots) - degree - 1
    np.testing.assert_allclose(N.sum(axis=1), 1.0, rtol=1e-13)
    assert N.min() >= -1e-15
    assert (np.count_nonzero(N, axis=1) <= degree + 1).all()


@given(knot_vectors(), st.integers(0, 6))
def test_values_and_derivatives_are_those_of_scipy(drawn, order):
    degree, knots = drawn
    x = np.setdiff1d(places(knots), knots)
    N = basis(knots, degree, x, order)
    for i in range(N.shape[1]):
        expected = BSpline(knots, np.eye(N.shape[1])[i], degree)(x, order)
        scale = (degree / np.diff(np.unique(knots)).min()) ** order
        np.testing.assert_allclose(N[:, i], expected, atol=1e-12 * scale)


@given(knot_vectors())
def test_the_right_end_belongs_to_the_last_b_spline(drawn):
    degree, knots = drawn
    ends = basis(knots, degree, knots[[0, -1]])
    np.testing.assert_allclose(ends[0], np.eye(ends.shape[1])[0], atol=1e-14)
    np.testing.assert_allclose(ends[1], np.eye(ends.shape[1])[-1], atol=1e-14)


def test_beyond_the_ends_the_last_polynomial_is_continued():
    knots = clamped(np.array([0.0, 0.3, 1.0]), 3)
    x = np.array([-0.2, 1.3])
    cubic = np.polynomial.Polynomial([1.0, -2.0, 0.5, 3.0])
    greville = np.linspace(0, 1, 5)
    c = np.linalg.solve(basis(knots, 3, greville), cubic(greville))
    np.testing.assert_allclose(basis(knots, 3, x) @ c, cubic(x), rtol=1e-12)


@pytest.mark.parametrize("count", [2, 3, 4, 5, 9])
def test_not_a_knot_interpolates_and_reproduces_the_polynomials_it_can_hold(count):
    nodes = np.sort(np.random.default_rng(count).uniform(0, 1, count))
    knots, degree = not_a_knot(nodes)
    assert degree == min(3, count - 1)
    at_nodes = basis(knots, degree, nodes)
    assert at_nodes.shape == (count, count)
    poly = np.polynomial.Polynomial([0.3, -1.0, 2.0, 4.0][: degree + 1])
    c = np.linalg.solve(at_nodes, poly(nodes))
    x = np.linspace(nodes[0], nodes[-1], 57)
    for order in range(degree + 1):
        expected = poly.deriv(order)(x) if order else poly(x)
        np.testing.assert_allclose(basis(knots, degree, x, order) @ c, expected, atol=1e-9)


def test_not_a_knot_is_the_spline_of_scipy():
    nodes = np.array([0.0, 0.1, 0.35, 0.4, 0.8, 1.0])
    values = np.sin(9 * nodes)
    knots, degree = not_a_knot(nodes)
    theirs = make_interp_spline(nodes, values, k=3)
    np.testing.assert_allclose(knots, theirs.t)
    c = np.linalg.solve(basis(knots, degree, nodes), values)
    np.testing.assert_allclose(c, theirs.c, rtol=1e-12)
