from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from threadpoolctl import threadpool_limits

from bladecad.curves.sides import split_sides
from bladecad.data.synthetic import synthetic_blade
from bladecad.fit.blade import Order
from bladecad.fit.left_out import left_out
from bladecad.fit.order import fit_blade

ORDER = Order(2, 2, 9)


@pytest.fixture(autouse=True, scope="module")
def one_thread():
    with threadpool_limits(1):
        yield


def found(sections, keep=None, **options):
    keep = keep or [np.ones(len(s.points), bool) for s in sections.sections]

    def split(masks):
        return split_sides(sections, keep=masks)

    fit = fit_blade(split(keep), tolerance=0.01, order=ORDER, **options)
    return left_out(sections, fit, keep, split), fit


def without_the_spline(sections):
    """The same points predicted by the periodic cubic through every second one, (k,) mm."""
    away = []
    for s in sections.sections:
        half = np.vstack([s.points[::2], s.points[:1]])
        w = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(half, axis=0), axis=1))])
        curve = CubicSpline(w, half, bc_type="periodic")(np.linspace(0, w[-1], 40001))
        away += [np.linalg.norm(curve - p, axis=1).min() for p in s.points[1::2]]
    return np.array(away)


def test_every_second_point_is_measured():
    sections = synthetic_blade(3, 120, tagged=True)
    alone, _ = found(sections)
    assert alone.points == 3 * 60
    assert 0 < alone.rms < alone.largest


def test_what_is_left_out_shrinks_as_points_are_added():
    errors = [found(synthetic_blade(3, n, tagged=True))[0].rms for n in (60, 120, 240)]
    assert errors[0] > 4 * errors[1] > 4 * errors[2]


def test_the_flow_predicts_points_left_out_as_well_as_the_interpolating_spline():
    sections = synthetic_blade(3, 100, tagged=True)
    alone, fit = found(sections)
    spline = without_the_spline(sections)
    assert alone.rms < 1.3 * np.sqrt(np.mean(spline**2)) + fit.errors.rms
    assert alone.largest < 1.3 * spline.max() + fit.errors.largest


def test_noise_of_the_points_is_what_is_left_out():
    """A point left out differs from its neighbours' curve by its noise and a share of theirs."""
    sigma, sections = 0.02, synthetic_blade(4, 240, tagged=True)
    rng = np.random.default_rng(2)
    sections = replace(
        sections,
        sections=tuple(
            replace(s, points=s.points + sigma * rng.normal(size=(240, 1)) * [0.0, 0.6, 0.8])
            for s in sections.sections
        ),
    )
    alone, _ = found(sections)
    assert 0.3 * sigma < alone.rms < 1.5 * sigma


def test_points_set_aside_are_neither_fitted_nor_counted():
    sections = synthetic_blade(3, 120, tagged=True)
    clean, _ = found(sections)
    points = sections.sections[1].points.copy()
    points[31] += [0.0, 3.0, -3.0]
    spoilt = replace(
        sections,
        sections=(
            sections.sections[0], replace(sections.sections[1], points=points), sections.sections[2]
        ),
    )  # fmt: skip
    keep = [np.ones(120, bool) for _ in range(3)]
    keep[1][31] = False
    alone, _ = found(spoilt, keep)
    assert alone.points == clean.points - 1
    assert alone.largest < 2 * clean.largest
    assert found(spoilt)[0].largest > 1.0


def test_rates_that_vary_and_cut_off_edges_can_be_left_out_too():
    alone, fit = found(synthetic_blade(3, 121, trailing_edge="blunt"), spectrum="varying")
    assert len(fit.suction.bases) == 3
    assert alone.largest < 0.05
