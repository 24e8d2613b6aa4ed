import numpy as np
import pytest

from bladecad.curves.sides import split_sides
from bladecad.data.synthetic import synthetic_blade
from bladecad.errors import FitError
from bladecad.fit.blade import Order
from bladecad.fit.judge import SPEED, Bench, Errors, SideErrors, judge
from bladecad.fit.modal import fit_spectra, prepare
from bladecad.fit.order import met
from bladecad.fit.search import spread
from bladecad.fit.sidefit import SideFit

FREEDOM = Order(4, 4, 4)  # n = 21 coefficients, as many as points


@pytest.fixture(scope="module")
def lines():
    return split_sides(synthetic_blade(3, 40, tagged=True))


@pytest.fixture(scope="module")
def bench(lines):
    return Bench.of(lines)


def through_the_points(lines, side, spectrum):
    """The same model fitted to the measured points alone, as one would without care."""
    curves = [
        np.linalg.lstsq(spectrum(t), lines.sample(side, t)[i], rcond=None)[0]
        for i, t in enumerate(lines.parameters(side))
    ]
    return SideFit((spectrum,), np.array(curves))


def wild(lines):
    spectrum = spread(FREEDOM.le, FREEDOM.te, FREEDOM.degree)
    return [through_the_points(lines, side, spectrum) for side in ("suction", "pressure")]


def test_the_trap_a_fit_perfect_at_the_points_and_wild_between_them_is_refused(lines, bench):
    sides = wild(lines)
    assert sides[0].bases[0].size == 21 == len(lines.parameters("suction")[0])
    for side, name in zip(sides, ("suction", "pressure"), strict=True):
        for i, t in enumerate(lines.parameters(name)):
            assert np.abs(side(t)[i] - lines.sample(name, t)[i]).max() < 1e-6
    errors = judge(bench, *sides)
    assert errors.at_points < 1e-6
    assert errors.largest > 1.0  # mm
    reason = errors.refusal(0.010)
    assert "between them: more freedom than these points can hold" in reason
    assert "um at the points" in reason


def test_the_same_freedom_fitted_to_the_densified_loop_is_not_wild(lines):
    spectrum = spread(FREEDOM.le, FREEDOM.te, FREEDOM.degree)
    fit = fit_spectra(prepare(lines), FREEDOM, (spectrum,), (spectrum,), 0.05)
    assert 0 < fit.errors.largest < 0.05


def errors(largest, at_points, speed=(1.0, 1.0)):
    side = SideErrors(np.array([largest]), np.array([largest]), np.zeros(1), np.array([at_points]))
    return Errors(side, side, speed)


@pytest.mark.parametrize(
    ("found", "words"),
    [
        (errors(0.009, 0.009), ""),
        (errors(0.011, 0.011), "11 um where 10 um are allowed"),
        (errors(0.011, 0.002), "2 um at the points, but 11 um between them"),
        (errors(0.001, 0.001, (0.5, 1.0)), "0.50 to 1.00 times the speed"),
        (errors(0.001, 0.001, (1.0, 1.6)), "1.00 to 1.60 times the speed"),
    ],
)
def test_the_refusal_says_why_in_numbers(found, words):
    assert found.refusal(0.010) == words if not words else words in found.refusal(0.010)


def test_errors_are_the_largest_distance_on_nine_samples_a_gap_and_know_where(lines, bench):
    spectrum = spread(1, 1, 7)
    fit = fit_spectra(prepare(lines), Order(1, 1, 7), (spectrum,), (spectrum,), 0.01)
    found = fit.errors
    for name, side in (("suction", fit.suction), ("pressure", fit.pressure)):
        t = np.linspace(0, 1, 20001)
        d = np.linalg.norm(side(t) - lines.sample(name, t), axis=2).max(axis=1)
        mine = getattr(found, name)
        assert (mine.largest <= d * (1 + 1e-6)).all()
        assert (mine.largest >= 0.98 * d).all()
        assert (mine.at_points <= mine.largest).all()
        assert (mine.rms < mine.largest).all()
    side, i, t = found.worst()
    there = np.array([t])
    curve = getattr(fit, side)(there)[i] - lines.sample(side, there)[i]
    assert np.linalg.norm(curve) == pytest.approx(found.largest, rel=1e-9)


def through(lines):
    spectrum = spread(2, 2, 7)
    fit = fit_spectra(prepare(lines), Order(2, 2, 7), (spectrum,), (spectrum,), 0.01)
    return fit.suction, fit.pressure


def test_the_speed_at_round_edges_is_one_on_the_data(lines, bench):
    fit = through(lines)
    low, high = judge(bench, *fit).speed
    assert SPEED[0] < low <= high < SPEED[1]
    assert high - low < 0.2
    twice = [SideFit(s.bases, 2 * s.coefficients) for s in fit]
    assert judge(bench, *twice).speed == pytest.approx((2 * low, 2 * high))


def test_a_blunt_edge_has_no_speed_to_keep():
    cut = split_sides(synthetic_blade(3, 41, trailing_edge="blunt", tagged=True))
    fit = [SideFit(s.bases, s.coefficients) for s in through(cut)]
    low, high = judge(Bench.of(cut), *fit).speed
    speeds = np.linalg.norm(fit[0](np.zeros(1), 1)[:, 0], axis=1) / cut.lengths
    assert (low, high) == pytest.approx((speeds.min(), speeds.max()))


def test_a_fit_with_a_reason_is_an_error_that_carries_the_fit(lines):
    spectrum = spread(1, 1, 3)
    poor = fit_spectra(prepare(lines), Order(1, 1, 3), (spectrum,), (spectrum,), 1e-4)
    with pytest.raises(FitError, match=r"no order meets 0\.1 um: 1 LE pairs.*closest") as refused:
        met(poor)
    assert refused.value.best is poor
    assert poor.margin == pytest.approx(1e-4 / poor.errors.largest)
