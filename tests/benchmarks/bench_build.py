"""How long a blade takes, step by step and whole; run by `make bench`."""

import subprocess
import sys
from pathlib import Path
from time import perf_counter

import pytest
from threadpoolctl import threadpool_limits

from bladecad.curves.sides import split_sides
from bladecad.data.synthetic import synthetic_blade
from bladecad.data.write import write_sections
from bladecad.fit.blade import Order
from bladecad.fit.order import fit_blade
from bladecad.pipeline import Settings, build, fit, load, split, surface_of
from bladecad.surface.loft import loft
from bladecad.surface.triangulate import triangulate

ROTOR37 = Path(__file__).resolve().parents[2] / "fixtures" / "rotor37" / "sections.csv"
ASKED = Settings(tolerance=0.012)
FRESH = "import sys; from bladecad.pipeline import build; assert build(sys.argv[1]).within"


@pytest.fixture(scope="module")
def lines():
    sections, _, keep = load(ROTOR37, ASKED)
    return split(sections, ASKED, keep)


@pytest.fixture(scope="module")
def surface(lines):
    with threadpool_limits(1):
        return surface_of(fit_blade(lines, tolerance=0.012, order=Order(4, 4, 17)))


@pytest.fixture(scope="module")
def large(tmp_path_factory):
    """21 sections of 240 points."""
    path = tmp_path_factory.mktemp("large") / "blade.csv"
    write_sections(synthetic_blade(21, 240), path)
    return path


def slow(benchmark, function, *arguments, rounds=3):
    return benchmark.pedantic(function, arguments, rounds=rounds, warmup_rounds=1)


def test_fit_both_sides_of_rotor_37_to_twelve_micrometres(benchmark, lines):
    found = slow(benchmark, fit, lines, ASKED)
    assert found.errors.largest <= 0.012
    assert benchmark.stats.stats.median <= 5.0


def test_build_21_sections_of_240_points_warm(benchmark, large):
    built = slow(benchmark, build, large)
    assert built.within
    benchmark.extra_info["seconds"] = {k: round(s, 3) for k, s in built.seconds.items()}
    assert benchmark.stats.stats.median <= 5.0


def test_build_21_sections_of_240_points_in_a_fresh_process(benchmark, large):
    command = [sys.executable, "-c", FRESH, str(large)]
    benchmark.pedantic(subprocess.run, [command], {"check": True}, rounds=3)
    assert benchmark.stats.stats.median <= 15.0


def test_loft_rotor_37_to_a_micrometre(benchmark, surface):
    lofted = slow(benchmark, lambda: loft(surface, tolerance=1e-3))
    benchmark.extra_info["poles"] = lofted.suction.poles.shape[:2]
    assert lofted.error <= 1e-3


def test_triangulate_rotor_37_to_five_micrometres(benchmark, surface):
    mesh = slow(benchmark, lambda: triangulate(surface, chord_error=0.005))
    benchmark.extra_info["triangles"] = len(mesh.triangles)
    assert mesh.chord_error <= 0.005


def seconds(function):
    """The quickest of three runs."""
    taken = []
    for _ in range(3):
        start = perf_counter()
        function()
        taken.append(perf_counter() - start)
    return min(taken)


def fitted(sections, points):
    lines = split_sides(synthetic_blade(sections, points))
    with threadpool_limits(1):
        return seconds(lambda: fit_blade(lines, tolerance=0.01, order=Order(3, 3, 11)))


def test_twice_the_points_take_at_most_three_times_as_long(benchmark):
    ratio = benchmark.pedantic(lambda: fitted(7, 240) / fitted(7, 120), rounds=1)
    benchmark.extra_info["ratio"] = round(ratio, 2)
    assert ratio < 3.0


def test_three_times_the_sections_take_at_most_three_times_as_long(benchmark):
    """They share one spectrum: the search sees little more than before."""
    ratio = benchmark.pedantic(lambda: fitted(21, 120) / fitted(7, 120), rounds=1)
    benchmark.extra_info["ratio"] = round(ratio, 2)
    assert ratio < 3.0
