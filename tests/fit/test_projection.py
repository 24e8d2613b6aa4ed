import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bladecad.fit.best_linear import best_linear, normal_equations
from bladecad.fit.projection import LOG_A, K, project
from bladecad.fit.search import spread
from bladecad.fit.spectrum import Spectrum

T = 0.5 - 0.5 * np.cos(np.pi * np.linspace(0, 1, 400))  # closer at the edges
TRUTH = Spectrum(5, np.array([[35.0, 1.5], [150.0, 0.6]]), np.array([[60.0, -0.3]]))


def coefficients(spectrum, columns, seed=5):
    """Like a blade's: a body of tens of millimetres, edges of one."""
    rng = np.random.default_rng(seed)
    C = rng.normal(size=(spectrum.size, columns))
    C[: spectrum.degree + 1] *= 20.0
    return C


def theta_of(spectrum):
    modes = np.concatenate([spectrum.le, spectrum.te])
    return np.column_stack([np.log(modes[:, 0]), modes[:, 1]]).ravel()


def with_theta(spectrum, theta):
    modes = np.reshape(theta, (-1, 2)) * 1.0
    modes[:, 0] = np.exp(modes[:, 0])
    cut = len(spectrum.le)
    return Spectrum(spectrum.degree, modes[:cut], modes[cut:], spectrum.knots)


def sorted_modes(pairs):
    return pairs[np.argsort(pairs[:, 0])]


def test_a_known_spectrum_is_recovered_from_its_own_samples():
    Y = TRUTH(T) @ coefficients(TRUTH, 9)
    (found,) = project(spread(2, 1, 5), T, [Y], steps=300)
    np.testing.assert_allclose(sorted_modes(found.le), TRUTH.le, rtol=1e-4)
    np.testing.assert_allclose(found.te, TRUTH.te, rtol=1e-4)
    assert best_linear(found, T, Y).rss < 1e-12 * np.vdot(Y, Y)


def test_sections_one_by_one_and_side_by_side_share_the_same_spectrum():
    Y = TRUTH(T) @ coefficients(TRUTH, 9)
    start = spread(2, 1, 5)
    (together,) = project(start, T, [Y])
    apart = project(start, T, np.split(Y, 3, axis=1))
    assert len(apart) == 3
    for one in apart:
        np.testing.assert_allclose(theta_of(one), theta_of(together), rtol=1e-6)


def test_rates_that_vary_linearly_with_span_are_recovered():
    hub, tip = np.log(40.0), np.log(90.0)
    u = np.linspace(0, 1, 5)
    modes = np.column_stack([np.exp(hub + u * (tip - hub)), 0.8 + u])
    family = [Spectrum(3, m[None], np.empty((0, 2))) for m in modes]
    blocks = [s(T) @ coefficients(s, 3, seed=i) for i, s in enumerate(family)]
    found = project(spread(1, 0, 3), T, blocks, np.column_stack([1 - u, u]), steps=300)
    for mine, theirs in zip(found, family, strict=True):
        np.testing.assert_allclose(mine.le, theirs.le, rtol=1e-5)
    (shared,) = project(spread(1, 0, 3), T, [np.hstack(blocks)], steps=300)
    assert best_linear(shared, T, np.hstack(blocks)).rss > 1e-4


@st.composite
def apart(draw):
    """One to two pairs of modes, their rates apart; where they agree the rank itself jumps."""
    k = draw(st.lists(st.floats(-0.8, 10), min_size=1, max_size=2))
    slow = draw(st.floats(10, 60))
    return np.column_stack([[slow, slow * draw(st.floats(1.5, 5))][: len(k)], k])


@settings(max_examples=25)
@given(apart(), apart(), st.integers(0, 6))
def test_the_gradient_is_the_finite_difference_of_the_sum_of_squares(le, te, degree):
    """Kaufman drops a term of J that is orthogonal to r: -J^T r is exact all the same."""
    spectrum = Spectrum(degree, le, te)
    Y = np.random.default_rng(1).normal(size=(len(T), 4)) + np.outer(np.exp(-25 * T), [9, 5, 7, 1])
    best, theta, h = best_linear(spectrum, T, Y), theta_of(spectrum), 1e-5

    def rss(change):
        return best_linear(with_theta(spectrum, theta + change), T, Y).rss

    slopes = [(rss(h * e) - rss(-h * e)) / (2 * h) for e in np.eye(len(theta))]
    _, g = normal_equations(best, T)
    np.testing.assert_allclose(-2 * g, slopes, atol=1e-6 * (1 + best.rss))


@pytest.mark.parametrize("k", [-1e-3, -1e-5, -1e-7, 0.0, 1e-7, 1e-5, 1e-3])
def test_the_gradient_passes_smoothly_through_the_double_rate(k):
    spectrum = Spectrum(2, np.array([[30.0, k]]), np.empty((0, 2)))
    near = Spectrum(2, np.array([[30.0, 0.01]]), np.empty((0, 2)))
    Y = near(T) @ coefficients(near, 3) + np.sin(40 * T)[:, None]
    h = 1e-4
    rss = [
        best_linear(with_theta(spectrum, [np.log(30.0), k + d]), T, Y).rss
        for d in (-2 * h, -h, h, 2 * h)
    ]
    slope = np.dot([1, -8, 8, -1], rss) / (12 * h)
    g = normal_equations(best_linear(spectrum, T, Y), T)[1]
    np.testing.assert_allclose(-2 * g[1], slope, rtol=1e-6)


def kaufman(spectrum, best, h=1e-6):
    """Kaufman's Jacobian, written plainly; below the samples stand the rows of the ridge."""
    theta, columns = theta_of(spectrum), []
    for e in np.eye(len(theta)):
        up, down = (with_theta(spectrum, theta + s * h * e)(T) for s in (1, -1))
        d = np.pad((up - down) / (2 * h) @ best.C, ((0, spectrum.size), (0, 0)))
        columns.append(-(d - best.Q @ (best.Q.T @ d)).ravel())
    return np.stack(columns, axis=1)


def test_the_normal_matrix_is_that_of_kaufmans_jacobian_written_plainly():
    Y = TRUTH(T) @ coefficients(TRUTH, 6) + np.cos(30 * T)[:, None]
    best = best_linear(TRUTH, T, Y)
    J = kaufman(TRUTH, best)
    H, g = normal_equations(best, T)
    np.testing.assert_allclose(H, J.T @ J, atol=1e-5 * np.abs(H).max())
    np.testing.assert_allclose(g, -J.T @ best.residual.ravel(), atol=1e-5 * np.abs(g).max())


def test_the_normal_matrix_keeps_its_sign_where_modes_are_nearly_polynomials():
    """Slow pairs beside a core of degree 11: large coefficients times small differences."""
    slow = Spectrum(11, np.array([[8.5, -0.85], [300.0, 0.5]]), np.array([[12.0, -0.9]]))
    Y = np.outer(np.exp(-9 * T) * np.sin(14 * T), [1.0, 0.5]) + np.cos(30 * T)[:, None]
    best = best_linear(slow, T, Y)
    assert np.abs(best.C).max() > 1e3
    H, _ = normal_equations(best, T)
    scaled = H / np.sqrt(np.outer(np.diag(H), np.diag(H)))
    assert np.linalg.eigvalsh(scaled).min() > -1e-12
    J = kaufman(slow, best)
    np.testing.assert_allclose(np.diag(H), (J**2).sum(axis=0), rtol=1e-4)


def test_dependent_columns_share_and_the_residual_is_still_the_least():
    twins = Spectrum(2, np.array([[30.0, 0.5], [30.0, 0.5]]), np.empty((0, 2)))
    one = Spectrum(2, np.array([[30.0, 0.5]]), np.empty((0, 2)))
    Y = np.sin(9 * T)[:, None]
    best, alone = best_linear(twins, T, Y), best_linear(one, T, Y)
    np.testing.assert_allclose(best.C[3:5] + best.C[5:], alone.C[3:], rtol=1e-6)
    assert np.abs(best.C).max() < 1e3
    assert best.rss == pytest.approx(alone.rss, rel=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_rates_stay_within_their_bounds_and_the_reach_of_the_samples(seed):
    """Noise asks for rates and stiffness without end."""
    rng = np.random.default_rng(seed)
    t = np.linspace(0, 1, 120)
    (found,) = project(spread(2, 2, 3), t, [rng.normal(size=(120, 6))])
    modes = np.concatenate([found.le, found.te])
    assert (np.log(modes[:, 0]) >= LOG_A[0] - 1e-12).all()
    assert (modes[:, 0] <= 119 * (1 + 1e-9)).all()
    assert (modes[:, 1] >= K[0]).all()
    assert (modes[:, 1] <= K[1]).all()


def test_no_step_ever_makes_it_worse():
    Y = np.sqrt(T)[:, None] + TRUTH(T) @ coefficients(TRUTH, 3)
    rss = [best_linear(project(spread(1, 1, 5), T, [Y], steps=n)[0], T, Y).rss for n in range(8)]
    assert (np.diff(rss) <= 0).all()
    assert rss[-1] < 0.5 * rss[0]


def test_what_is_held_at_a_bound_does_not_hold_up_the_others():
    """The data ask for a stiffness beyond the bound: the other rate is found all the same."""
    beyond = Spectrum(3, np.array([[20.0, 60.0]]), np.array([[80.0, 0.7]]))
    Y = beyond(T) @ coefficients(beyond, 6)
    (found,) = project(spread(1, 1, 3), T, [Y], steps=300)
    assert found.le[0, 1] == K[1]
    theta, least = theta_of(found), best_linear(found, T, Y).rss
    for e in np.eye(4)[[0, 2, 3]]:
        for change in np.linspace(-0.2, 0.2, 21):
            near = with_theta(found, theta + change * e)
            assert best_linear(near, T, Y).rss > 0.999 * least


def test_without_modes_there_is_nothing_to_find():
    start = spread(0, 0, 7)
    assert project(start, T, [np.sin(T)[:, None]])[0].size == 8
