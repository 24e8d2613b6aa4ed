"""What a replay finds on the default blade."""

import numpy as np
import pytest

from bladecad.replay.ladder import RUNGS
from bladecad.replay.subject import REGIONS


def largest(results, region, rung):
    return next(
        s.score.largest
        for s in results.ladder
        if (s.blade, s.region, s.rung) == (results.blade.name, region, rung)
    )


def test_runge_kutta_and_the_exponential_agree(results):
    assert max(p.runge_kutta for p in results.plain) < 1e-5


def test_arc_length_steps_are_better_on_the_core_and_diverge_on_rounded_edges(results):
    core_uniform, core, _, full = results.plain
    assert np.all(core.absolute < 0.5 * core_uniform.absolute)
    assert full.absolute.max() > 100 * core.absolute.max()


@pytest.mark.parametrize("region", REGIONS)
def test_each_improvement_that_counts_is_one(results, region):
    rungs = ["arc length", "second order", "on the trajectory", "8 segments", "modal, n = 34"]
    errors = [largest(results, region, rung) for rung in rungs]
    assert errors == sorted(errors, reverse=True)


@pytest.mark.parametrize("region", REGIONS)
def test_more_modes_follow_closer_and_closer_than_a_spline(results, region):
    modal = [largest(results, region, r) for r in RUNGS if "modal" in r]
    assert modal == sorted(modal, reverse=True)
    assert modal[-1] < largest(results, region, "B-spline, n = 34")


def test_the_ladder_has_every_rung_for_every_blade(results):
    found = [(s.blade, s.region, s.rung) for s in results.ladder]
    assert len(found) == len(set(found)) == 2 * 2 * len(RUNGS)


def test_the_spline_law_has_no_crease_and_predicts_better(results):
    linear, spline = results.laws["linear"], results.laws["spline"]
    assert linear.crease.min() > 0.1
    assert spline.crease.max() < 1e-5
    assert np.median(spline.left_out) < np.median(linear.left_out)


def test_only_models_without_a_constant_care_where_the_origin_is(results):
    cares = {m.rung for m in results.moves if not m.stays}
    assert cares == {"uniform steps", "arc length", "midpoint"}
    for m in results.moves:
        if "modal" in m.rung:
            assert m.there.largest == pytest.approx(m.here.largest, rel=0.05)


def test_the_paper_surface_meets_the_lines_of_its_sections(results):
    surface, plain = results.paper["core"], results.plain[1]
    np.testing.assert_allclose(surface.points[::6], plain.curves, atol=1e-8)
    assert np.all(np.diff(surface.u) > 0)
