"""The search for rates and the fit by tolerance; run by `make bench`."""

from pathlib import Path

import pytest
from threadpoolctl import threadpool_limits

from bladecad.curves.sides import split_sides
from bladecad.data.read import read_sections
from bladecad.fit.best_linear import best_linear, normal_equations
from bladecad.fit.modal import prepare
from bladecad.fit.order import fit_blade
from bladecad.fit.search import find_rates, spread

ROTOR37 = Path(__file__).resolve().parents[2] / "fixtures" / "rotor37" / "sections.csv"


@pytest.fixture(scope="module", autouse=True)
def one_thread():
    with threadpool_limits(1):
        yield


@pytest.fixture(scope="module")
def lines():
    return split_sides(read_sections(ROTOR37))


@pytest.fixture(scope="module")
def side(lines):
    essence = prepare(lines).essences[0]
    return essence.t, essence.together


def test_the_best_coefficients_and_how_the_rates_pull(benchmark, side):
    t, Y = side
    H, _ = benchmark(lambda: normal_equations(best_linear(spread(4, 4, 17), t, Y), t))
    assert H.shape == (16, 16)


@pytest.mark.parametrize(("m", "p"), [(2, 9), (3, 13), (4, 17)])
def test_find_the_rates_of_one_side(benchmark, side, m, p):
    t, Y = side
    found = benchmark.pedantic(find_rates, (m, m, p, t, Y), rounds=3)
    benchmark.extra_info["rms, of the size"] = float((best_linear(found, t, Y).rss / Y.size) ** 0.5)
    assert benchmark.stats.stats.median <= 2.0


def test_fit_rotor_37_by_tolerance(benchmark, lines):
    fit = benchmark.pedantic(lambda: fit_blade(lines, tolerance=0.012), rounds=3)
    benchmark.extra_info["order"] = str(fit.order)
    assert fit.errors.largest <= 0.012
    assert benchmark.stats.stats.median <= 5.0
