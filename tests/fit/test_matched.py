from dataclasses import replace

import numpy as np
import pytest

from bladecad.curves.sides import split_sides
from bladecad.data.sections import Section, Sections, Source
from bladecad.data.synthetic import profiles, synthetic_blade
from bladecad.errors import FitError
from bladecad.fit.flow import evaluate
from bladecad.fit.matched import fit_matched, side_of
from bladecad.fit.matching import identify
from bladecad.fit.samples import shared_parameters
from bladecad.fit.second_order import Ends

MODELS = ("paper", "affine", "second-order")
SIDES = ("suction", "pressure")
T = np.linspace(0, 1, 301)


def core(sections=4, points=36):
    """The smooth part of a blade, both edges cut off."""
    half = np.linspace(0.4, np.pi - 0.4, points)
    phi = np.concatenate([half, half + np.pi])
    last = 2 * points - 1
    return Sections(
        tuple(
            Section(f"{k}", p.place(p.outline(phi)), True, (last, 0), (points - 1, points), "first")
            for k, p in enumerate(profiles(sections))
        ),
        Source(None, "core"),
    )


@pytest.fixture(scope="module")
def lines():
    return split_sides(core())


@pytest.fixture(scope="module", params=MODELS)
def fit(request, lines):
    return fit_matched(lines, model=request.param, tolerance=0.01)


def test_the_smooth_core_is_followed_to_a_tenth_of_a_millimetre(fit):
    assert fit.errors.largest < 0.1
    assert fit.order is None
    assert fit.reason
    assert fit.margin < 1


def test_each_section_is_the_flow_that_identify_finds_for_it(fit, lines):
    for name in SIDES:
        t = shared_parameters(lines.parameters(name), 1)
        rows = lines.sample(name, t)
        for i, row in enumerate(rows):
            ends = Ends(start=row[0], end=row[-1]) if fit.model == "second-order" else None
            alone = identify(row, np.diff(t), model=fit.model, scheme="midpoint", ends=ends)
            mine = getattr(fit, name)(T)[i]
            np.testing.assert_allclose(mine, evaluate(alone.flow, T), atol=1e-9)


def test_the_second_order_sides_begin_and_end_at_their_points(lines):
    fit = fit_matched(lines, model="second-order", tolerance=0.01)
    ends = np.array([0.0, 1.0])
    for name in SIDES:
        np.testing.assert_allclose(getattr(fit, name)(ends), lines.sample(name, ends), atol=1e-9)


def test_the_first_order_sides_begin_at_their_points_only(lines):
    for model in ("paper", "affine"):
        fit = fit_matched(lines, model=model, tolerance=0.01)
        for name in SIDES:
            away = np.abs(
                getattr(fit, name)(np.array([0.0, 1.0])) - lines.sample(name, np.array([0.0, 1.0]))
            )
            assert away[:, 0].max() < 1e-9
            assert away[:, 1].max() > 1e-4


def test_the_derivative_of_each_side_is_its_own(fit):
    h = 1e-6
    for name in SIDES:
        side = getattr(fit, name)
        t = T[5:-5]
        slope = (side(t + h) - side(t - h)) / (2 * h)
        np.testing.assert_allclose(side(t, 1), slope, rtol=1e-5, atol=1e-3)


@pytest.mark.parametrize("model", ["paper", "affine"])
def test_a_flow_that_leaves_the_blade_is_refused_with_numbers(model):
    """Three states cannot follow a round edge."""
    with pytest.raises(FitError, match=r"model (strays|diverges)") as refused:
        fit_matched(split_sides(synthetic_blade(3, 120)), model=model, tolerance=0.01)
    assert "--model modal" in str(refused.value)
    best = refused.value.best
    assert best is None or best.errors.largest > 0.1 * best.lines.lengths.max()


def test_more_sections_do_not_change_one_that_stays(lines):
    whole = fit_matched(lines, model="affine", tolerance=0.01)
    blade = core()
    kept = replace(blade, sections=blade.sections[:3])
    fewer = fit_matched(split_sides(kept), model="affine", tolerance=0.01)
    apart = np.abs(whole.suction(T)[:3] - fewer.suction(T)).max()
    assert apart < 0.01


def test_states_of_different_number_are_filled_up_without_changing_the_curve():
    t = np.linspace(0, 1, 40)
    rows = [np.column_stack([9 * t, np.sin(2 * t + k), t**2]) for k in range(2)]
    fits = [
        identify(rows[0], np.diff(t), model="affine"),
        identify(rows[1], np.diff(t), model="second-order"),
    ]
    side = side_of(fits)
    assert side.bases[0].size == side.bases[1].size == len(fits[1].flow.z0)
    for mine, one in zip(side(T), fits, strict=True):
        np.testing.assert_allclose(mine, evaluate(one.flow, T), atol=1e-10)
