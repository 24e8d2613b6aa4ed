"""Where the scan does not reach, the blade is not measured, and the share of it is right."""

import numpy as np
import pytest

from bladecad.deviation.inspecting.coverage import map_of
from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.surface.loft import SIDES
from bladecad.tolerance import Tolerances, uniform
from tests.deviation.scanned import blade, feet_at, placed, strewn


def area_of(name, u, t):
    """Area of a rectangle of u and t by a dense midpoint rule."""
    U, T = (a + (b - a) * (np.arange(400) + 0.5) / 400 for a, b in (u, t))
    n = np.cross(blade()(name, U, T, 1, 0), blade()(name, U, T, 0, 1))
    return np.linalg.norm(n, axis=2).mean() * (u[1] - u[0]) * (t[1] - t[0])


def mapped(suction, u, t, d=0.0, tolerances=None):
    feet = placed(suction, u, t, d)
    return map_of(nominal_of(blade()), feet, tolerances or uniform(0.1))


def test_cells_hold_the_points_that_lie_on_them():
    suction, u, t = strewn(30_000, 1)
    d = np.random.default_rng(1).normal(size=30_000)
    found = mapped(suction, u, t, d)
    for k, on in enumerate((suction, ~suction)):
        slow = np.histogram2d(u[on], t[on], [found.u, found.t])[0]
        np.testing.assert_array_equal(found.count[k], slow)
        for i, j in [(0, 0), (3, 7), (-1, -1)]:
            a, b = np.arange(len(found.u) - 1)[i], np.arange(len(found.t) - 1)[j]
            there = on & (u >= found.u[a]) & (u <= found.u[a + 1])
            there &= (t >= found.t[b]) & (t <= found.t[b + 1])
            assert there.any()
            assert found.mean[k, i, j] == pytest.approx(d[there].mean())
            assert found.lowest[k, i, j] == d[there].min()
            assert found.highest[k, i, j] == d[there].max()
    whole = sum(area_of(name, (0, 1), (0, 1)) for name in SIDES)
    assert found.area.sum() == pytest.approx(whole, rel=1e-3)


def test_borders_of_zones_are_borders_of_cells():
    t = Tolerances(uniform(0.1).zones, le_zone=0.03, te_zone=0.05, hub_margin=0.07, tip_margin=0.2)
    found = mapped(*strewn(5000, 2), tolerances=t)
    for border, borders in ((0.03, found.t), (0.95, found.t), (0.07, found.u), (0.8, found.u)):
        assert np.abs(borders - border).min() < 1e-12


@pytest.mark.parametrize("count", [3000, 30_000, 300_000])
def test_cells_are_as_fine_as_the_points_fill_them(count):
    found = mapped(*strewn(count, 3))
    assert found.share > 0.995
    mean = count / found.count.size
    assert mean > 3.0
    assert mean < 40.0 or found.count.shape[1] == 80


@pytest.mark.parametrize(("count", "off"), [(6000, 0.2), (60_000, 0.1), (400_000, 0.04)])
def test_a_hole_is_not_measured_and_its_share_is_right(count, off):
    suction, u, t = strewn(count, 4)
    hole = suction & (np.abs(u - 0.55) < 0.15) & (np.abs(t - 0.4) < 0.2)
    found = mapped(suction[~hole], u[~hole], t[~hole])
    missing = found.area[~found.measured].sum()
    assert missing == pytest.approx(area_of("suction", (0.4, 0.7), (0.2, 0.6)), rel=off)
    assert found.measured[1].mean() > 0.995


def test_one_side_alone_is_half_a_blade():
    suction, u, t = strewn(20_000, 5)
    found = mapped(suction[suction], u[suction], t[suction])
    assert found.measured[0].all()
    assert not found.measured[1, :, 1:-1].any()
    assert found.share == pytest.approx(0.5, abs=0.02)


@pytest.mark.parametrize("points", [60, 1000])
def test_lines_of_a_measuring_machine_speak_for_their_neighbourhood_and_no_further(points):
    def lines(heights):
        u = np.repeat(heights, 2 * points)
        t = np.tile(np.linspace(0, 1, points), 2 * len(heights))
        suction = np.tile(np.repeat([True, False], points), len(heights))
        return mapped(suction, u, t)

    assert lines(np.linspace(0, 1, 13)).share > 0.99
    two = lines(np.array([0.25, 0.75]))
    assert two.share == pytest.approx(0.2, abs=0.03)
    assert len(two.u) == 11


def test_points_beyond_the_span_measure_nothing():
    suction, u, t = strewn(5000, 6)
    rim = u < 0.5
    feet = feet_at(blade(), suction, np.where(rim, 0.0, u), t, 0.0, rim=rim)
    found = map_of(nominal_of(blade()), feet, uniform(0.1))
    assert found.count.sum() == (~rim).sum()
    assert not found.measured[:, found.u[1:] < 0.45].any()


def test_the_face_of_a_cut_off_edge_is_part_of_the_area():
    round_, blunt = (
        map_of(nominal_of(blade(edge)), feet_at(blade(edge), *strewn(5000), 0.0))
        for edge in ("round", "blunt")
    )
    S, P = (blade("blunt")(name, np.linspace(0, 1, 201), np.ones(1))[:, 0] for name in SIDES)
    width = np.linalg.norm(S - P, axis=1).mean()
    height = np.linalg.norm(np.diff(0.5 * (S + P), axis=0), axis=1).sum()
    sides = sum(
        np.linalg.norm(
            np.cross(blade("blunt")(n, x, x, 1, 0), blade("blunt")(n, x, x, 0, 1)), axis=2
        ).mean()
        for x in [(np.arange(400) + 0.5) / 400]
        for n in SIDES
    )
    assert blunt.area.sum() - sides == pytest.approx(width * height, rel=0.02)
    assert round_.area.sum() > 0
