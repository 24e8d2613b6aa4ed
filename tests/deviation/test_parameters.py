"""The numbers of a section are right for a changed blade, and as uncertain as they say."""

import numpy as np
import pytest

from bladecad.curves.properties import properties
from bladecad.curves.sides import split_sides
from bladecad.data.synthetic import synthetic_blade
from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.deviation.nearest.project import project
from bladecad.deviation.sectioning.knots import Round
from bladecad.deviation.sectioning.moved import movement
from bladecad.deviation.sectioning.numbers import formulas, numbers
from bladecad.deviation.sectioning.parameters import Number
from bladecad.deviation.sectioning.sections import section_results
from bladecad.deviation.sectioning.station import stations_at
from bladecad.deviation.sectioning.trend import trend
from bladecad.tolerance import PARAMETERS, Band, Tolerances, uniform
from tests.deviation.scanned import AXIS, blade, feet_at, moved, scan_of, strewn

TOLERANCES = uniform(0.05)


def near(count, at=0.5, seed=0):
    """Points near a station, crowded at the edges, as edges are scanned."""
    suction, u, t = strewn(count, seed, at - 0.02, at + 0.02)
    return suction, u, 0.5 * (1.0 + np.tanh(3.0 * (2.0 * t - 1.0)) / np.tanh(3.0))


def measured(surface, feet, u=0.5):
    (result,) = section_results(nominal_of(surface), feet, {"S": u}, TOLERANCES, axis=AXIS)
    return result


def itself(surface, u=0.5):
    """Numbers of a blade's own section."""
    (station,) = stations_at(surface, {"S": u}, AXIS)
    return {k: float(v[0]) for k, v in formulas(station, TOLERANCES)(station.flat[None]).items()}


@pytest.mark.parametrize("edge", ["round", "blunt"])
def test_an_unchanged_blade_has_no_deviation_at_all(edge):
    found = measured(blade(edge), feet_at(blade(edge), *near(3000), 0.0))
    for number in found.numbers:
        if number.reason:
            assert "face" in number.reason
            continue
        assert number.deviation == pytest.approx(0.0, abs=1e-12), number.name
    np.testing.assert_allclose(found.deviation[found.measured], 0.0, atol=1e-12)


def test_nominal_numbers_are_those_of_the_section_table():
    lines = split_sides(synthetic_blade(5, 80))
    table = properties(lines, AXIS)[2]
    own = itself(blade(), float(lines.span[2]))
    assert own["chord"] == pytest.approx(table.chord, abs=0.03)
    assert own["stagger"] == pytest.approx(np.degrees(table.stagger), abs=0.1)
    assert own["maximum thickness"] == pytest.approx(table.thickness, abs=0.005)
    bow = table.camber * table.chord  # from a chord whose ends lie elsewhere on the edge arcs
    assert own["camber"] == pytest.approx(bow, abs=table.le_radius)
    place = table.thickness_place * table.chord
    assert own["maximum thickness place"] == pytest.approx(place, abs=0.2)


@pytest.mark.parametrize("d", [0.04, -0.04])
def test_a_blade_offset_by_d_has_d_more_on_every_side(d):
    found = measured(blade(), feet_at(blade(), *near(4000), d))
    np.testing.assert_allclose(found.deviation, d, atol=1e-9)
    for name, times in (("maximum thickness", 2), ("chord", 2)):
        assert found.number(name).deviation == pytest.approx(times * d, rel=0.02)
    for name in ("leading edge radius", "trailing edge radius"):
        assert found.number(name).deviation == pytest.approx(d, rel=0.06)  # no circle, nearly one
    for region in ("leading edge", "trailing edge", "concave", "convex"):
        for end in ("min", "max"):
            assert found.number(f"{region} contour {end}").actual == pytest.approx(d, abs=1e-9)
    assert found.number("stagger").deviation == pytest.approx(0.0, abs=1e-3)


def turned(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[1, 0, 0], [0, c, -s], [0, s, c]])  # about the span, which is x


CHANGES = {
    "twisted": lambda i, C, one: C @ turned(2e-3 * i).T,
    "shifted": lambda i, C, one: C + 0.02 * i * np.outer(one, [0.0, 0.6, 0.8]),
    "thicker": lambda i, C, one: C * np.array([1.0, 1.002, 1.001]),
}


@pytest.mark.parametrize("change", CHANGES)
def test_numbers_told_by_points_are_those_of_the_changed_blade_itself(change):
    """Points on a blade that was really changed, projected on the nominal."""
    actual = moved(blade(), CHANGES[change])
    u = float(blade().span[2])
    points = scan_of(actual, *near(1500, u, 3)).points
    found = measured(blade(), project(nominal_of(blade()), points), u)
    own, before = itself(actual, u), itself(blade(), u)
    for name in ("chord", "stagger", "maximum thickness", "camber", "leading edge radius",
                 "trailing edge radius", "leading edge thickness at 1 mm",
                 "trailing edge thickness at 1 mm"):  # fmt: skip
        number = found.number(name)
        assert number.nominal == pytest.approx(before[name], abs=1e-9)
        assert number.actual == pytest.approx(own[name], abs=4e-3), name
    assert found.number("stagger").deviation == pytest.approx(
        {"twisted": -np.degrees(4e-3), "shifted": 0.0}.get(
            change, own["stagger"] - before["stagger"]
        ),
        abs=4e-3,
    )


def test_bow_is_the_shift_of_the_section_along_and_across_its_chord():
    actual = moved(blade(), CHANGES["shifted"])
    u = float(blade().span[2])
    points = scan_of(actual, *near(1500, u, 4)).points
    found = measured(blade(), project(nominal_of(blade()), points), u)
    (station,) = stations_at(blade(), {"S": u}, AXIS)
    le, te = station.points[0], station.points[240]
    along = (te - le) / np.linalg.norm(te - le)
    middle = station.points.mean(axis=0)
    up = station.points[120] - middle - ((station.points[120] - middle) @ along) * along
    up = up / np.linalg.norm(up)
    shift = 0.02 * 2 * np.array([0.0, 0.6, 0.8])
    assert found.number("bow along").actual == pytest.approx(shift @ along, abs=2e-3)
    assert found.number("bow across").actual == pytest.approx(shift @ up, abs=2e-3)
    assert abs(found.number("stagger").deviation) < 2e-3


def test_fits_of_a_section_move_it_as_the_blade_was_moved():
    actual = moved(blade(), CHANGES["shifted"])
    u = float(blade().span[2])
    feet = project(nominal_of(blade()), scan_of(actual, *near(1500, u, 4)).points)
    found = measured(blade(), feet, u)
    bow = [found.number(f"bow {way}").actual for way in ("along", "across")]
    kinds = {fit.kind: fit for fit in found.fits}
    assert set(kinds) == {"least squares", "min-max", "leading edge", "trailing edge"}
    np.testing.assert_allclose(kinds["least squares"].shift, bow, atol=2e-3)
    assert kinds["least squares"].after[2] < 0.2 * kinds["least squares"].before[2]
    limited = Tolerances(TOLERANCES.zones, {"bow across": Band(-0.005, 0.005)})
    (held,) = section_results(nominal_of(blade()), feet, {"S": u}, limited, axis=AXIS)
    fit = next(fit for fit in held.fits if fit.kind == "constrained")
    assert abs(fit.shift[1]) <= 0.005 + 1e-9


def test_twist_is_the_stagger_less_that_of_the_section_at_the_hub():
    actual = moved(blade(), CHANGES["twisted"])
    stations = {str(k): float(x) for k, x in enumerate(blade().span)}
    points = [scan_of(actual, *near(800, np.clip(x, 0.02, 0.98), 5)).points for x in blade().span]
    feet = project(nominal_of(blade()), np.concatenate(points))
    found = section_results(nominal_of(blade()), feet, stations, TOLERANCES, axis=AXIS)
    for k, section in enumerate(found):
        twist = section.number("twist")
        assert twist.deviation == pytest.approx(-np.degrees(2e-3 * k), abs=0.01)
        assert (
            twist.nominal == section.number("stagger").nominal - found[0].number("stagger").nominal
        )
    assert found[0].number("twist").deviation == 0.0


def test_a_thicker_body_is_thicker_there_and_the_same_at_its_edges():
    suction, u, t = near(4000, seed=6)
    d = 0.03 * np.clip(np.sin(np.pi * np.clip((t - 0.15) / 0.7, 0, 1)), 0, None) ** 2
    found = measured(blade(), feet_at(blade(), suction, u, t, d))
    thick = found.number("maximum thickness")
    assert thick.deviation == pytest.approx(0.06, abs=0.002)
    for name in ("chord", "leading edge radius", "trailing edge radius"):
        assert found.number(name).deviation == pytest.approx(0.0, abs=1e-3), name
    assert found.number("convex contour max").actual == pytest.approx(0.03, abs=1e-3)
    assert found.number("convex contour min").actual == pytest.approx(0.0, abs=1e-3)


def test_the_face_of_a_cut_off_edge_makes_the_chord():
    surface = blade("blunt")
    suction, u, t = near(3000, seed=7)
    sides = feet_at(surface, suction, u, t, 0.0)
    assert measured(surface, sides).number("chord").reason.startswith("the face")
    face = np.full(3000, 0)
    face[::30] = 3
    t[::30] = 1.0
    feet = feet_at(surface, suction, u, t, np.where(face == 3, 0.05, 0.0), face)
    found = measured(surface, feet)
    assert found.number("chord").deviation == pytest.approx(0.05, rel=0.2)
    assert found.number("maximum thickness").deviation == pytest.approx(0.0, abs=1e-9)
    assert "trailing edge radius" not in {n.name for n in found.numbers}


REPEATS = 200


def repeats(count, level):
    """Numbers and truth of a section measured again and again, its deviation within the splines."""
    surface = blade()
    (station,) = stations_at(surface, {"S": 0.5}, AXIS)
    formula = formulas(station, TOLERANCES)
    suction, u, t = near(count, seed=8)
    u = np.full(count, 0.5) if level else u
    base = feet_at(surface, suction, u, t, 0.0)
    rng = np.random.default_rng(9)
    plain = trend(station, base)
    c = np.append(0.02 * rng.normal(size=len(plain.coefficients) - 2), [0.0, 0.0])
    c = 0.5 * (c + np.roll(c, 1))
    c[-2:] = 0.0
    truth = formula(movement(station, plain).outlines(c, 1e-4)[1:2])
    d = plain.round(station.arc_of(suction, t)) @ c[:-2] + (0 if level else 0.4) * (u - 0.5)
    for _ in range(REPEATS):
        feet = feet_like(base, d + rng.normal(0, 0.008, count))
        yield (
            {n.name: n for n in numbers(formula, trend(station, feet), TOLERANCES)},
            truth,
        )


def feet_like(feet, d):
    fields = feet.foot, feet.normal, feet.face, feet.suction, feet.u, feet.t, feet.rim
    return type(feet)(d, *fields)


@pytest.mark.parametrize(("count", "level"), [(500, False), (240, True)])
def test_the_truth_lies_inside_95_of_100_stated_intervals(count, level):
    """Of 200 repeats a number that is right 95 % of the time holds fewer than 173 once in 1e5.

    scipy.stats.binom.cdf(172, 200, 0.95) = 1.1e-6 for each of about a dozen numbers. Together they
    are 95 +/- 3 %: the standard error of the mean of wholly dependent numbers is 1.5 %.
    """
    inside, told = {}, 0
    for found, truth in repeats(count, level):
        for name, true in truth.items():
            number = found[name]
            if number.actual is not None:
                inside.setdefault(name, []).append(
                    abs(number.actual - true[0]) <= number.uncertainty
                )
        told += 1
    assert len(inside) >= 8
    shares = {name: np.mean(hits) for name, hits in inside.items()}
    assert all(len(hits) == told for hits in inside.values())
    assert min(shares.values()) >= 173 / 200, shares
    assert 0.92 <= np.mean([*shares.values()]) <= 0.98, shares


def test_fewer_and_noisier_points_make_wider_intervals():
    def half(count, noise):
        rng = np.random.default_rng(11)
        feet = feet_at(blade(), *near(count, seed=10), rng.normal(0, noise, count))
        return measured(blade(), feet).number("maximum thickness").uncertainty

    assert half(4000, 0.02) == pytest.approx(2 * half(4000, 0.01), rel=0.1)
    assert half(1000, 0.01) > 1.3 * half(4000, 0.01)


def test_what_the_points_leave_out_is_not_made_up():
    suction, u, t = near(4000, seed=12)
    seen = t > 0.03
    feet = feet_at(blade(), suction[seen], u[seen], t[seen], 0.01)
    found = measured(blade(), feet)
    for name in ("chord", "stagger", "leading edge radius", "leading edge contour max"):
        number = found.number(name)
        assert number.actual is None
        assert number.uncertainty is None
        assert "measured" in number.reason
    assert found.number("trailing edge radius").actual is not None
    assert not found.measured[found.t < 0.01].any()
    assert np.isnan(found.deviation[found.t < 0.01]).all()
    whole = measured(blade(), feet_at(blade(), suction, u, t, 0.01))
    for name in ("bow along", "bow across"):
        assert found.number(name).uncertainty > 10 * whole.number(name).uncertainty


def test_a_section_without_points_has_only_nominal_numbers():
    found = measured(blade(), feet_at(blade(), *near(4000, 0.8), 0.0), 0.2)
    assert found.points == 0
    assert not found.measured.any()
    for number in found.numbers:
        assert number.actual is None
        assert number.reason
    assert found.number("chord").nominal == pytest.approx(itself(blade(), 0.2)["chord"])


def test_an_outlier_bends_nothing():
    suction, u, t = near(3000, seed=13)
    d = np.random.default_rng(14).normal(0, 0.003, 3000)
    spoiled = d + np.where(np.arange(3000) % 500 == 0, 2.0, 0.0)
    clean, dirty = (measured(blade(), feet_at(blade(), suction, u, t, x)) for x in (d, spoiled))
    for name in ("chord", "maximum thickness", "leading edge radius", "convex contour max"):
        assert dirty.number(name).actual == pytest.approx(clean.number(name).actual, abs=2e-3)


def test_splines_round_a_loop_sum_to_one_and_are_smooth_across_the_edges():
    breaks = np.array([0.0, 0.3, 1.0, 2.5, 4.0, 4.4, 5.0])
    step = 1e-6
    for te in (None, 2.5):
        loop = Round(breaks, te, True)
        s = np.linspace(0, 5, 333)
        np.testing.assert_allclose(loop(s).sum(axis=1), 1.0)
        np.testing.assert_allclose(loop(s), loop(s + 5.0), atol=1e-12)
        here, there = loop(np.array([-step, step]))
        np.testing.assert_allclose(here, there, atol=1e-4)
    broken = Round(breaks, 2.5, True)(np.array([2.5 - step, 2.5]))
    assert np.abs(np.diff(broken, axis=0)).max() > 0.99
    open_ = Round(breaks, None, False)(np.array([0.0, 5.0]))
    assert np.abs(np.diff(open_, axis=0)).max() == pytest.approx(1.0)


def test_a_number_is_held_to_its_band():
    band = Band(-0.1, 0.2)
    number = Number("chord", "mm", 50.0, 50.15, 0.02, band)
    assert number.deviation == pytest.approx(0.15)
    assert (number.within, number.sure) == (True, True)
    assert Number("chord", "mm", 50.0, 50.15, 0.06, band).sure is False
    off = Number("chord", "mm", 50.0, 49.8, 0.06, band)
    assert (off.within, off.sure) == (False, True)
    assert Number("chord", "mm", 50.0, None, None, band, "no").within is False
    assert Number("chord", "mm", 50.0, 51.0, 0.1).within is None


def test_numbers_are_told_in_one_order_each_once():
    found = measured(blade(), feet_at(blade(), *near(2000), 0.0))
    names = [number.name.split(" at ")[0] for number in found.numbers]
    assert [*dict.fromkeys(names)] == [*PARAMETERS]
