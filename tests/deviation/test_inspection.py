"""The whole inspection: what is wrong with a blade is found, named and placed."""

from dataclasses import dataclass, field

import numpy as np
import pytest

from bladecad.data.scan import Scan
from bladecad.data.sections import Source
from bladecad.deviation.inspecting.inspection import inspect
from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.deviation.nearest.referee import Referee
from bladecad.errors import DataError
from bladecad.tolerance import Band, Tolerances, uniform
from tests.deviation.scanned import Still, blade, scan_of, strewn

COUNT = 6000


@dataclass(frozen=True)
class Turned:
    """Stands for a registration that turns and shifts."""

    T_nominal_scan: np.ndarray = field(
        default_factory=lambda: np.array(
            [[0, -1, 0, 5], [1, 0, 0, 7], [0, 0, 1, -9], [0, 0, 0, 1.0]]
        )
    )


def inspected(d=0.0, tolerances=None, keep=None, registration=None, **more):
    suction, u, t = strewn(COUNT, 1, 0.01, 0.99)
    t = 0.5 * (1.0 + np.tanh(2.0 * (2.0 * t - 1.0)) / np.tanh(2.0))
    d = np.broadcast_to(d(suction, u, t) if callable(d) else d, COUNT)
    kept = np.ones(COUNT, bool) if keep is None else keep(suction, u, t)
    scan = scan_of(blade(), suction[kept], u[kept], t[kept], d[kept])
    return inspect(
        nominal_of(blade()), scan, registration=registration or Still(),
        tolerances=tolerances or uniform(0.05), stations=more.pop("stations", [0.3, 0.7]), **more,
    )  # fmt: skip


def bump(suction, u, t):
    return 0.12 * suction * np.exp(-((u - 0.7) ** 2 + (t - 0.4) ** 2) / 0.05**2)


def test_a_good_blade_is_good():
    found = inspected()
    assert found.within
    assert found.reasons == ()
    assert found.beyond == 0
    assert {z.name for z in found.zones} == set(found.tolerances.present)
    assert [s.name for s in found.sections] == ["u = 0.3", "u = 0.7"]
    assert set(found.seconds) == {"projection", "referee", "zones", "sections"}
    np.testing.assert_allclose(found.feet.distance, 0.0, atol=1e-6)


@pytest.mark.parametrize("d", [0.06, -0.06])
def test_a_blade_offset_by_d_measures_d_everywhere_sign_included(d):
    found = inspected(d)
    assert not found.within
    for zone in found.zones:
        assert zone.mean == pytest.approx(d, abs=1e-5)
        assert zone.out_points == zone.points
    for section in found.sections:
        np.testing.assert_allclose(section.deviation[section.measured], d, atol=1e-5)
        assert section.measured.mean() > 0.9
    assert all(f"from {d:+.4f}" in reason for reason in found.reasons)


def test_a_bump_is_found_with_size_and_place():
    found = inspected(bump)
    (reason,) = found.reasons
    assert "points of the suction side are out of -0.05 .. +0.05 mm" in reason
    worst = found.worst[0]
    assert worst.deviation == found.feet.distance.max()
    assert worst.deviation == pytest.approx(0.12, rel=0.1)  # no point stands on its very top
    assert (worst.side, worst.zone, worst.section) == ("suction", "suction side", "u = 0.7")
    assert (worst.u, worst.t) == pytest.approx((0.7, 0.4), abs=0.02)
    np.testing.assert_allclose(worst.point, found.scan.points[worst.index], atol=1e-6)
    assert sum(place.excess > 0 for place in found.worst) == 1
    low, high = found.sections
    assert high.number("convex contour max").actual == pytest.approx(0.12, rel=0.1)
    assert abs(low.number("convex contour max").actual) < 5e-3
    top = int(np.nanargmax(high.deviation))
    assert high.suction[top]
    assert high.t[top] == pytest.approx(0.4, abs=0.03)


def test_a_hole_is_not_measured_and_a_reason_where_coverage_is_asked():
    def seen(suction, u, t):
        return ~(~suction & (np.abs(u - 0.5) < 0.2) & (np.abs(t - 0.5) < 0.2))

    asked = Tolerances(uniform(0.05).zones, coverage={"pressure side": 0.9})
    found = inspected(keep=seen, tolerances=asked)
    (reason,) = found.reasons
    assert "of the pressure side is measured, 90 % must be" in reason
    pressure = next(z for z in found.zones if z.name == "pressure side")
    assert pressure.coverage == pytest.approx(1.0 - 0.4 * 0.4 / 0.96, abs=0.04)
    assert inspected(keep=seen).within


def test_a_blade_without_its_leading_edge_is_not_good():
    found = inspected(keep=lambda suction, u, t: t > 0.05)
    assert found.reasons == ("the leading edge has no point: it is not measured",)


def test_a_number_out_of_its_band_is_a_reason_with_section_and_size():
    asked = Tolerances(uniform(0.2).zones, {"maximum thickness": Band(-0.05, 0.05)})
    found = inspected(bump, asked)
    (reason,) = found.reasons
    assert reason.startswith('section "u = 0.7": maximum thickness is off by +')
    assert reason.endswith("allowed are -0.05 .. +0.05 mm")
    blind = inspected(
        0.0, Tolerances(asked.zones, {"chord": Band(-1, 1)}), keep=lambda s, u, t: t > 0.03
    )
    assert any('section "u = 0.3": chord is not known' in reason for reason in blind.reasons)


def test_points_are_moved_by_the_registration_before_they_are_measured():
    good = inspected()
    T = Turned().T_nominal_scan
    scan = Scan((good.scan.points - T[:3, 3]) @ T[:3, :3], None, Source(None, "made up"))
    found = inspect(
        nominal_of(blade()), scan, registration=Turned(), tolerances=uniform(0.05), stations=[0.5]
    )
    np.testing.assert_allclose(found.feet.distance, 0.0, atol=1e-6)


def test_points_beyond_the_span_are_counted_and_measure_nothing():
    suction, u, t = strewn(2000, 2, 0.9, 1.0)
    there = scan_of(blade(), suction, u, t).points
    up = np.where((np.arange(2000) < 500)[:, None], [30.0, 0.0, 0.0], 0.0)
    found = inspect(
        nominal_of(blade()), Scan(there + up, None, Source(None, "made up")),
        registration=Still(), tolerances=uniform(0.05), stations=[0.95],
    )  # fmt: skip
    assert found.beyond == 500
    assert sum(zone.points for zone in found.zones) == 1500
    assert not any(zone.out_points for zone in found.zones)
    assert (found.zone == -1).sum() == 500


def test_the_referee_hears_the_moved_points_and_their_feet():
    heard = []

    def referee(points, feet):
        heard.append((points, feet))
        return Referee(3, 0.0, 1.0)

    found = inspected(referee=referee)
    assert found.referee == Referee(3, 0.0, 1.0)
    assert len(heard[0][0]) == len(heard[0][1].distance) == COUNT


@pytest.mark.parametrize("stations", [[], [1.2], {"S1": -0.1}])
def test_stations_off_the_blade_are_refused(stations):
    with pytest.raises(DataError, match="station"):
        inspected(stations=stations)


def test_a_scan_that_misses_the_blade_is_refused():
    points = np.column_stack([np.full(50, 900.0), *np.random.default_rng(1).normal(size=(2, 50))])
    with pytest.raises(DataError, match="none of its 50 points lies between hub and tip"):
        inspect(
            nominal_of(blade()), Scan(points, None, Source(None, "made up")),
            registration=Still(), tolerances=uniform(0.05),
        )  # fmt: skip
