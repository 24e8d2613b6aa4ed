import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm

from bladecad.fit.flow import Flow, trajectory_rk4
from bladecad.fit.spectrum import Spectrum, decay, pair, pair_matrix, pairs

stiffness = st.floats(-0.9, 20.0)
rates = st.tuples(st.floats(8.0, 400.0), stiffness)
modes = st.lists(rates, max_size=3).map(lambda rows: np.reshape(rows, (-1, 2)))
spectra = st.builds(Spectrum, st.integers(0, 9), modes, modes)
times = st.floats(0, 1)

MODERATE = Spectrum(4, np.array([[9.0, 0.4], [14.0, -0.6]]), np.array([[11.0, 3.0]]))
T = np.linspace(0, 1, 101)


@given(spectra, st.integers(0, 4))
def test_each_derivative_is_the_system_applied_to_the_one_before(spectrum, order):
    z, rate = spectrum(T, order), spectrum(T, order + 1)
    scale = np.abs(z).max(axis=0) @ np.abs(spectrum.A).T + 1e-300
    np.testing.assert_allclose(rate / scale, z @ spectrum.A.T / scale, atol=1e-12)


@given(spectra)
def test_the_state_changes_as_the_system_says(spectrum):
    """The derivative against differences of the state alone, order four."""
    t, h = np.linspace(0.01, 0.99, 9), 1e-3 / (1 + np.abs(spectrum.A).max())
    near = [spectrum(t + j * h) for j in (-2, -1, 1, 2)]
    difference = np.einsum("j,jtn->tn", [1, -8, 8, -1], near) / (12 * h)
    scale = np.abs(spectrum.A).sum(axis=1) + 1.0
    np.testing.assert_allclose(difference / scale, spectrum(t, 1) / scale, atol=1e-8)


@given(st.integers(0, 9), modes, times, times)
def test_the_flow_is_a_group_where_nothing_grows(degree, le, s, t):
    spectrum = Spectrum(degree, le, np.empty((0, 2)))
    z = spectrum(np.array([t, s + t]))
    moved = expm(spectrum.A * s) @ z[0]
    np.testing.assert_allclose(moved, z[1], atol=1e-11 * (1 + np.abs(z).max()) * 2**degree)


@given(st.integers(0, 5), modes, times, times)
def test_backwards_the_trailing_edge_modes_are_the_same_group(degree, te, s, t):
    spectrum = Spectrum(degree, np.empty((0, 2)), te)
    z = spectrum(np.array([1.0 - t, 1.0 - t - s]))
    moved = expm(-spectrum.A * s) @ z[0]
    np.testing.assert_allclose(moved, z[1], atol=1e-11 * (1 + np.abs(z).max()) * 4**degree)


@pytest.mark.parametrize("t", [0.0, 0.3, 1.0])
def test_both_kinds_of_modes_together_follow_the_matrix_exponential(t):
    z = expm(MODERATE.A * t) @ MODERATE(np.zeros(1))[0]
    np.testing.assert_allclose(MODERATE(np.array([t]))[0], z, rtol=1e-9, atol=1e-12)


def test_runge_kutta_reaches_the_closed_form_with_order_four():
    flow = Flow(MODERATE.A, np.ones((3, MODERATE.size)), MODERATE(np.zeros(1))[0])
    exact = MODERATE(T) @ flow.C.T
    errors = [np.abs(trajectory_rk4(flow, T, n) - exact).max() for n in (1, 2, 4, 8)]
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:]))[1:], 4.0, atol=0.15)


@given(stiffness, st.floats(0, 30))
def test_a_pair_is_the_exponential_of_its_matrix(k, tau):
    exact = expm(pair_matrix(1.0, k) * tau) @ [1.0, 0.0]
    np.testing.assert_allclose(
        np.ravel(decay(np.array([[tau]]), np.array([k]))), exact, rtol=1e-9, atol=1e-12
    )


def test_many_pairs_at_once_are_each_the_exponential_of_its_matrix():
    """One that turns, one that creeps, one between them, and one of each again, in no order."""
    rates = np.array([[9.0, 4.0], [30.0, -0.5], [12.0, 0.0], [8.0, 20.0], [50.0, -0.9]])
    for order in (0, 2):
        exact = [
            [expm(M * t) @ np.linalg.matrix_power(M, order)[:, 0] for t in T]
            for M in (pair_matrix(a, k) for a, k in rates)
        ]
        scale = rates[:, :1, None] ** order
        np.testing.assert_allclose(pairs(rates, T, order) / scale, exact / scale, atol=1e-10)


@given(st.floats(8, 400), stiffness)
def test_a_pair_obeys_its_equation_of_second_order(a, k):
    y, dy, ddy = (pair(a, k, T, r)[:, 1] for r in range(3))
    np.testing.assert_allclose(ddy / a**2, -2 * dy / a - (1 + k) * y, atol=1e-13 * (1 + k) ** 2)


def test_decay_runs_smoothly_through_the_double_rate():
    """Divided differences over k through 0 agree with the series of order three in k."""
    tau = np.linspace(0, 20, 81)
    series = np.exp(-tau) * np.array(
        [
            [np.ones_like(tau), -(tau**2) / 2, tau**4 / 24],
            [tau, -(tau**3) / 6, tau**5 / 120],
        ]
    )
    for k in (1e-3, 1e-6, 1e-9, 1e-12, 0.0, -1e-12, -1e-9, -1e-6, -1e-3):
        y = np.concatenate(decay(tau[None], np.array([k])))
        expected = np.einsum("irt,r->it", series, [1.0, k, k**2])
        np.testing.assert_allclose(y, expected, atol=1e-15 + abs(k) ** 3 * 100)


@given(modes, modes, st.integers(0, 12))
def test_no_mode_exceeds_its_start_and_each_dies_away_from_its_edge(le, te, degree):
    """The first state is at most 1, and the second relaxes towards it: y2' = a (y1 - y2)."""
    z = Spectrum(degree, le, te)(T)
    core = degree + 1
    assert np.abs(z[:, core:]).max(initial=0.0) <= 1.0 + 1e-12
    np.testing.assert_allclose(z[0, core : core + 2 * len(le)], np.tile([1.0, 0.0], len(le)))
    np.testing.assert_allclose(z[-1, core + 2 * len(le) :], np.tile([1.0, 0.0], len(te)))


def test_the_fastest_modes_stay_finite_at_every_order():
    fast = np.array([[5000.0, 20.0], [5000.0, -0.9]])
    for order in range(4):
        assert np.isfinite(Spectrum(21, fast, fast)(T, order)).all()


@given(spectra, st.lists(st.floats(0.01, 0.99), max_size=3, unique=True))
def test_one_gives_the_constant(spectrum, knots):
    for ends in ([], sorted(knots)):
        spread = [k for i, k in enumerate(ends) if i == 0 or k - ends[i - 1] > 1e-6]
        with_knots = Spectrum(spectrum.degree, spectrum.le, spectrum.te, np.array(spread))
        assert with_knots.size == with_knots(T).shape[1]
        np.testing.assert_allclose(with_knots(T) @ with_knots.one, 1.0, rtol=1e-12)


@pytest.mark.parametrize("degree", [3, 5, 7])
def test_restarted_at_knots_two_derivatives_are_continuous_and_the_third_jumps(degree):
    knots, h = np.array([0.3, 0.7]), 1e-12
    core = Spectrum(degree, np.empty((0, 2)), np.empty((0, 2)), knots)
    for order in range(4):
        jump = np.abs(core(knots + h, order) - core(knots - h, order)).max(axis=1)
        scale = np.abs(core(T, order)).max()
        assert (jump < 1e-8 * scale).all() == (order <= 2)
        assert (jump > 0.1 * scale).all() == (order == 3)


@given(st.integers(0, 7), st.lists(st.floats(0.05, 0.95), min_size=1, max_size=4))
def test_the_restarted_core_holds_every_polynomial_of_its_degree(degree, knots):
    knots = np.unique(np.round(knots, 2))
    core = Spectrum(degree, np.empty((0, 2)), np.empty((0, 2)), knots)
    whole = Spectrum(degree, np.empty((0, 2)), np.empty((0, 2)))
    C = np.linalg.lstsq(core(T), whole(T), rcond=None)[0]
    np.testing.assert_allclose(core(T) @ C, whole(T), atol=1e-10)
    assert core.size == degree + 1 + len(knots) * max(degree - 2, 1)


def test_the_size_is_what_the_method_says():
    modes = np.ones((3, 2))
    assert Spectrum(15, modes, modes).size == 4 * 3 + 15 + 1
