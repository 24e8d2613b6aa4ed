"""Zones take what lies on them; points and area out of tolerance are those that are."""

import numpy as np
import pytest

from bladecad.deviation.inspecting.coverage import map_of
from bladecad.deviation.inspecting.worst import worst_places
from bladecad.deviation.inspecting.zones import ZONES, excess, zone_of, zone_results
from bladecad.deviation.nearest.feet import FACES
from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.tolerance import Band, Tolerances, uniform
from tests.deviation.scanned import blade, feet_at, placed, strewn

ALL = Tolerances(
    {name: Band(-0.01 * (k + 1), 0.02 * (k + 1)) for k, name in enumerate(ZONES)},
    le_zone=0.03, te_zone=0.04, hub_margin=0.1, tip_margin=0.05,
)  # fmt: skip


def results(feet, tolerances):
    zone = zone_of(feet, tolerances)
    out = excess(feet.distance, zone, tolerances)
    map_ = map_of(nominal_of(blade()), feet, tolerances)
    return zone, out, map_, {z.name: z for z in zone_results(feet, zone, out > 0, map_, tolerances)}


@pytest.mark.parametrize(
    ("suction", "u", "t", "face", "rim", "name"),
    [
        (True, 0.5, 0.5, 0, False, "suction side"),
        (False, 0.5, 0.5, 1, False, "pressure side"),
        (True, 0.5, 0.029, 0, False, "leading edge"),
        (False, 0.5, 0.961, 1, False, "trailing edge"),
        (False, 0.5, 0.959, 1, False, "pressure side"),
        (True, 0.09, 0.01, 0, False, "hub margin"),
        (True, 0.951, 0.5, 0, False, "tip margin"),
        (True, 0.5, 0.9, FACES.index("TRAILING_EDGE"), False, "trailing edge"),
        (True, 0.05, 1.0, FACES.index("TRAILING_EDGE"), False, "hub margin"),
        (True, 0.0, 0.5, 0, True, None),
    ],
)
def test_margins_go_before_edges_and_edges_before_sides(suction, u, t, face, rim, name):
    one = [np.array([x]) for x in (suction, u, t)]
    feet = feet_at(blade(), *one, 0.0, np.array([face]), np.array([rim]))
    assert zone_of(feet, ALL)[0] == (-1 if name is None else ZONES.index(name))


def test_points_in_each_zone_are_held_to_its_own_band():
    feet = feet_at(blade(), *strewn(4000, 1), np.random.default_rng(2).normal(0, 0.05, 4000))
    zone, out, _, found = results(feet, ALL)
    assert set(found) == set(ZONES)
    for k, (name, result) in enumerate(found.items()):
        d = feet.distance[zone == k]
        band = ALL.zones[name]
        assert result.points == len(d) > 0
        assert result.out_points == sum((x < band.lower) or (x > band.upper) for x in d)
        assert (result.lowest, result.highest) == (d.min(), d.max())
        assert result.rms == pytest.approx(np.sqrt((d**2).mean()))
        np.testing.assert_allclose(np.maximum(out[zone == k], 0), band.excess(d), atol=1e-15)
    assert sum(z.area for z in found.values()) == pytest.approx(
        map_of(nominal_of(blade()), feet, ALL).area.sum()
    )


@pytest.mark.parametrize("d", [0.03, -0.03])
def test_a_blade_offset_by_d_is_off_by_d_in_every_zone_sign_included(d):
    found = results(feet_at(blade(), *strewn(20_000, 3), d), uniform(0.02))[3]
    for zone in found.values():
        assert (zone.lowest, zone.highest, zone.mean) == pytest.approx((d, d, d))
        assert zone.out_points == zone.points
        assert zone.out_area == pytest.approx(zone.measured_area)
        assert not zone.within
        assert "out of -0.02 .. +0.02 mm" in zone.reasons[0]
    assert all(
        z.within for z in results(feet_at(blade(), *strewn(20_000), d), uniform(0.04))[3].values()
    )


def test_the_area_of_a_bump_is_found_in_its_zone_alone():
    suction, u, t = strewn(200_000, 4)
    bump = suction & (np.abs(u - 0.5) < 0.1) & (np.abs(t - 0.5) < 0.15)
    feet = placed(suction, u, t, np.where(bump, 0.1, 0.0))
    found = results(feet, uniform(0.05))[3]
    x = np.linspace(-1, 1, 101)
    U, T = 0.5 + 0.1 * x, 0.5 + 0.15 * x
    n = np.cross(blade()("suction", U, T, 1, 0), blade()("suction", U, T, 0, 1))
    true = np.linalg.norm(n, axis=2).mean() * 0.2 * 0.3
    assert found["suction side"].out_area == pytest.approx(true, rel=0.02)
    assert found["suction side"].out_points == bump.sum()
    assert all(z.out_points == z.out_area == 0 for n, z in found.items() if n != "suction side")


def test_a_few_points_may_be_out_where_the_tolerances_say_so():
    suction, u, t = strewn(10_000, 5)
    d = np.where(np.arange(10_000) % 200 == 0, 0.1, 0.0)
    feet = feet_at(blade(), suction, u, t, d)
    strict, lax = (Tolerances(uniform(0.05).zones, allowed_out=share) for share in (0.001, 0.02))
    assert not results(feet, strict)[3]["suction side"].within
    assert results(feet, lax)[3]["suction side"].within


def test_a_zone_without_points_is_never_good_and_little_coverage_is_a_reason():
    suction, u, t = strewn(20_000, 6)
    seen = (t > 0.03) & ((u > 0.5) | ~suction)
    feet = feet_at(blade(), suction[seen], u[seen], t[seen], 0.0)
    found = results(feet, Tolerances(uniform(0.05).zones, coverage={"suction side": 0.8}))[3]
    assert found["leading edge"].reasons == ("the leading edge has no point: it is not measured",)
    assert found["leading edge"].measured_area == 0.0
    assert np.isnan(found["leading edge"].mean)
    assert "of the suction side is measured, 80 % must be" in found["suction side"].reasons[0]
    assert found["pressure side"].within


def test_worst_places_are_the_bumps_and_not_thirty_points_of_one():
    suction, u, t = strewn(50_000, 7)
    at = [(0.3, 0.3, 0.09), (0.7, 0.6, -0.07), (0.5, 0.85, 0.05)]
    d = sum(h * np.exp(-((u - a) ** 2 + (t - b) ** 2) / 0.02**2) for a, b, h in at) * suction
    feet = feet_at(blade(), suction, u, t, d)
    zone, out, _, _ = results(feet, uniform(0.02))
    worst = worst_places(feet, zone, out, {"low": 0.2, "high": 0.8})
    for place, (a, b, h) in zip(worst, at, strict=False):
        assert place.deviation == pytest.approx(h, rel=0.05)
        assert place.excess == pytest.approx(abs(place.deviation) - 0.02)
        assert (place.side, place.zone) == ("suction", "suction side")
        assert (place.u, place.t) == pytest.approx((a, b), abs=0.01)
        assert place.section == ("low" if a < 0.5 else "high") or a == 0.5
        k = place.index
        np.testing.assert_allclose(place.point, feet.foot[k] + d[k] * feet.normal[k])
    assert [p.excess for p in worst] == sorted((p.excess for p in worst), reverse=True)
    assert sum(p.excess > 0 for p in worst) == 3
    assert worst[0].deviation == d.max()
