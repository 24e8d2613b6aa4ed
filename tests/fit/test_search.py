"""The search for rates: what it finds, and that rounding does not choose for it."""

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from bladecad.curves.sides import split_sides
from bladecad.data.read import read_sections
from bladecad.fit.best_linear import best_linear
from bladecad.fit.growth import grown, shrunk
from bladecad.fit.modal import prepare
from bladecad.fit.projection import project
from bladecad.fit.search import find_rates, spread
from bladecad.fit.spectrum import Spectrum

T = 0.5 - 0.5 * np.cos(np.pi * np.linspace(0, 1, 400))
TRUTH = Spectrum(5, np.array([[35.0, 1.5], [150.0, 0.6]]), np.array([[60.0, -0.3]]))
C = np.random.default_rng(5).normal(size=(TRUTH.size, 9)) * np.repeat([20.0, 1.0], [6, 6])[:, None]
Y = TRUTH(T) @ C
ORDERS = [(1, 5), (2, 9), (3, 13), (4, 17)]


@pytest.fixture(autouse=True, scope="module")
def one_thread():
    with threadpool_limits(1):
        yield


@pytest.fixture(scope="module")
def sides(fixtures):
    data = prepare(split_sides(read_sections(fixtures / "rotor37" / "sections.csv")))
    return [(e.t, e.together) for e in data.essences]


def rss(spectrum, t, Y):
    return best_linear(spectrum, t, Y).rss


def by_rate(pairs):
    return pairs[np.argsort(pairs[:, 0])]


def test_a_known_spectrum_is_found_from_the_samples_alone():
    found = find_rates(2, 1, 5, T, Y)
    np.testing.assert_allclose(by_rate(found.le), TRUTH.le, rtol=1e-3)
    np.testing.assert_allclose(found.te, TRUTH.te, rtol=1e-3)


def test_pairs_are_put_at_the_edge_that_needs_them():
    """One pair at the trailing edge in the data: it is the first, and the rest is nothing."""
    one = Spectrum(5, np.empty((0, 2)), np.array([[60.0, -0.3]]))
    Y = one(T) @ C[: one.size]
    few = grown(0, 1, 5, T, Y)
    assert rss(few, T, Y) < 1e-4 * rss(grown(1, 0, 5, T, Y), T, Y)


@pytest.mark.parametrize(("le", "te"), [(0, 0), (0, 3), (2, 0), (3, 1)])
def test_as_many_pairs_are_grown_as_were_asked_for(le, te):
    found = grown(le, te, 4, T, Y)
    assert (len(found.le), len(found.te), found.degree) == (le, te, 4)


def test_what_is_missed_least_goes_first():
    more = Spectrum(5, np.vstack([TRUTH.le, [400.0, 3.0]]), np.vstack([[20.0, 5.0], TRUTH.te]))
    less = shrunk(more, 2, 1, 5, T, Y)
    np.testing.assert_array_equal(less.le, TRUTH.le)
    np.testing.assert_array_equal(less.te, TRUTH.te)


@pytest.mark.parametrize(("m", "p"), ORDERS)
def test_the_search_is_not_worse_than_from_evenly_spread_rates(sides, m, p):
    """A start given up early would have ended 6 % better at most, in the root of the squares."""
    for t, Y in sides:
        (plain,) = project(spread(m, m, p), t, [Y])
        assert rss(find_rates(m, m, p, t, Y), t, Y) < 1.06**2 * rss(plain, t, Y)


@pytest.mark.parametrize(("m", "p"), ORDERS)
def test_rounding_does_not_choose_between_the_minima(sides, m, p):
    """A thousand times the last digit of the data: the same minimum."""
    rng = np.random.default_rng(2)
    for t, Y in sides:
        here = rss(find_rates(m, m, p, t, Y), t, Y)
        for _ in range(3):
            near = find_rates(m, m, p, t, Y + 2e-13 * rng.normal(size=Y.shape))
            assert rss(near, t, Y) == pytest.approx(here, rel=0.02)
