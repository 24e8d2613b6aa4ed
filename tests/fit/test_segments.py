import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from bladecad.curves.sides import split_sides
from bladecad.data.sections import Section, Sections, Source
from bladecad.data.synthetic import synthetic_blade
from bladecad.fit.modal import prepare
from bladecad.fit.order import fit_blade
from bladecad.fit.segments import MOST, fit_segments

SIDES = ("suction", "pressure")


@pytest.fixture(autouse=True, scope="module")
def one_thread():
    with threadpool_limits(1):
        yield


def buckled(sections=4, points=240, depth=5.0):
    """Curvature jumps at 60 % of the suction side, as where a polished patch meets a milled one."""
    blade = synthetic_blade(sections, points, tagged=True)
    loops = []
    for s in blade.sections:
        chord = s.points[s.te[0]] - s.points[s.le[0]]
        x = (s.points - s.points[s.le[0]]) @ chord / (chord @ chord)
        first = np.arange(points) <= s.te[0]
        bump = depth * np.clip(x - 0.6, 0, None) ** 2 * np.clip(1 - x, 0, None) ** 3 * 40 * first
        across = np.cross(chord, [1.0, 0.0, 0.0]) / np.linalg.norm(chord)
        loops.append(s.points + bump[:, None] * across)
    return Sections(
        tuple(
            Section(s.name, loop, True, s.le, s.te, s.suction)
            for s, loop in zip(blade.sections, loops, strict=True)
        ),
        Source(None, "buckled"),
    )


@pytest.fixture(scope="module")
def data():
    return prepare(split_sides(buckled()))


@pytest.fixture(scope="module")
def fit(data):
    return fit_segments(data, 5e-4, lambda _: None)


def test_a_jump_of_curvature_in_the_body_is_followed_by_restarting_the_core(fit):
    assert fit.reason == ""
    assert fit.model == "segmented"
    assert fit.errors.largest <= 5e-4
    assert 0 < fit.order.knots <= MOST
    assert fit.order.knots == max(len(s.bases[0].knots) for s in (fit.suction, fit.pressure))


def test_the_restarted_curve_is_continuous_to_the_second_derivative(fit):
    for side in (fit.suction, fit.pressure):
        knots, h = side.bases[0].knots, 1e-11
        for order in range(3):
            jump = np.abs(side(knots + h, order) - side(knots - h, order)).max()
            assert jump < 1e-6 * np.abs(side(np.linspace(0, 1, 301), order)).max()


def test_the_knots_stand_apart_and_inside(fit):
    for side in (fit.suction, fit.pressure):
        knots = side.bases[0].knots
        assert (np.diff(knots, prepend=0.0, append=1.0) > 1e-4).all()


def test_sides_still_meet_in_value_tangent_and_curvature(fit):
    ends = np.array([0.0, 1.0])
    for order in range(3):
        S, P = fit.suction(ends, order), fit.pressure(ends, order)
        assert np.abs(S - (-1.0) ** order * P).max() < 1e-9 * np.abs(S).max()


def test_segments_come_in_only_where_no_order_meets_the_tolerance(data):
    assert fit_blade(data.lines, tolerance=0.05).model == "modal"


def test_a_tolerance_out_of_reach_gives_the_closest_fit_with_its_reason(data):
    best = fit_segments(data, 1e-7, lambda _: None)
    assert best.reason
    assert best.errors.largest > 1e-7
    assert best.errors.largest < 5e-4


def test_knots_are_told_as_they_are_tried(data):
    told = []
    fit_segments(data, 2e-3, told.append)
    assert told[0] == "0 knots"
    assert all(line.endswith("knots") for line in told)
