"""What is drawn of a check: triangles, whiskers, histogram, colours."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from bladecad.deviation.inspecting.coverage import Map
from bladecad.deviation.inspecting.zones import ZONES
from bladecad.export.check.colours import MAP, colours, limit_of, line_share, round_up
from bladecad.export.check.histogram import histogram
from bladecad.export.check.map import MOST, bridged, coarser
from bladecad.export.check.mesh import CAP, painted
from bladecad.export.check.whiskers import PARTS, REACH, round_down, thinned, whiskers
from bladecad.surface.triangulate import triangulate
from tests.export.inspections import blade, inspection


@pytest.mark.parametrize("edge", ["round", "blunt"])
def test_the_drawn_blade_is_the_blade_with_its_normals_outwards(edge):
    found = inspection(blade(edge))
    drawn = painted(found)
    body = trimesh.Trimesh(drawn.vertices, drawn.triangles, process=False)
    fine = triangulate(blade(edge), chord_error=0.01)
    assert body.is_winding_consistent
    assert body.volume == pytest.approx(fine.volume, rel=0.02)
    if edge == "round":
        assert body.is_watertight


@pytest.mark.parametrize("edge", ["round", "blunt"])
def test_every_triangle_carries_what_its_cell_measured(edge):
    found = inspection(blade(edge), cells=(8, 10))
    drawn, chart = painted(found), found.map
    for zone in np.unique(drawn.zone):
        part = drawn[drawn.zone == zone]
        if zone == CAP:
            assert np.isnan(part.mean).all()
            continue
        assert set(part.mean[part.measured]) <= set(chart.mean[chart.measured])
        both = np.concatenate([chart.lowest[chart.measured], chart.highest[chart.measured]])
        assert set(part.extreme[part.measured]) <= set(both)
        assert np.isnan(part.mean[~part.measured]).all()
    names = {ZONES[zone] for zone in np.unique(drawn.zone) if zone != CAP}
    assert names == set(found.tolerances.present)
    suction = drawn[drawn.zone == ZONES.index("suction side")]
    most = chart.mean[0].max(where=chart.measured[0], initial=-1.0)
    assert suction.mean[suction.measured].max() == pytest.approx(most)


def test_a_map_too_fine_to_draw_keeps_counts_means_and_extremes():
    rng = np.random.default_rng(4)
    shape = (2, 101, 203)
    count = rng.integers(0, 4, shape)
    mean = np.where(count > 0, rng.normal(size=shape), np.nan)
    fine = Map(np.linspace(0, 1, 102), np.linspace(0, 1, 204), count, mean, mean - 1.0, mean + 1.0,
               np.ones(shape), count > 0)  # fmt: skip
    coarse = coarser(fine)
    assert coarse.count[0].size <= MOST < fine.count[0].size
    assert coarse.count.sum() == count.sum()
    assert coarse.area.sum() == pytest.approx(fine.area.sum())
    assert np.nansum(coarse.mean * coarse.count) == pytest.approx(np.nansum(mean * count))
    assert np.nanmin(coarse.lowest) == np.nanmin(fine.lowest)
    assert np.nanmax(coarse.highest) == np.nanmax(fine.highest)
    assert set(coarse.u) <= set(fine.u)


def test_a_measured_cell_without_points_shows_what_is_beside_it_and_no_other_does():
    chart = inspection(missing=False).map
    mean, measured = np.ones(chart.mean.shape), np.ones(chart.mean.shape, bool)
    mean[0, 3, 4], mean[1, 5:8, 5:8] = np.nan, np.nan
    measured[1, 5:8, 5:8] = False
    mean[0, 3, 5] = 5.0
    found = bridged(replace(chart, mean=mean, measured=measured)).mean
    assert found[0, 3, 4] == pytest.approx(2.0)
    assert np.isnan(found[1, 5:8, 5:8]).all()
    assert np.isnan(found).sum() == 9


def test_whiskers_are_as_long_as_deviation_times_magnification():
    found = inspection()
    w = whiskers(found, found.sections[0])
    for part in PARTS:
        m = w.magnification(part)
        length = np.linalg.norm(w.moved(w.deviation, m) - w.line, axis=1)
        known = np.isfinite(w.deviation)
        np.testing.assert_allclose(length[known], m * np.abs(w.deviation[known]), rtol=1e-9)
        extent = np.ptp(w.line[w.within(part)], axis=0).max()
        sizes = np.abs(np.column_stack([w.deviation, w.bounds])[w.within(part)])
        assert 0.4 * REACH * extent < m * np.nanmax(sizes) * 1.01 <= REACH * extent * 1.02
    assert w.magnification("leading edge") < w.magnification("section")


def test_fewer_whiskers_keep_the_worst_one_and_the_order():
    found = inspection()
    w = whiskers(found, found.sections[1])
    few = thinned(w, 25)
    assert len(few.t) == 25
    assert few.deviation[few.worst] == w.deviation[w.worst]
    places = [int(np.flatnonzero((w.line == row).all(axis=1))[0]) for row in few.line]
    assert places == sorted(places)
    assert thinned(w, 10_000) is w


def test_a_section_that_was_not_measured_has_no_worst_place():
    found = inspection()
    none = np.full(len(found.sections[0].t), np.nan)
    w = whiskers(found, replace(found.sections[0], deviation=none, uncertainty=none))
    assert w.worst is None
    assert w.magnification() > 1.0  # the band is still drawn
    assert len(thinned(w, 20).t) == 20


def test_the_bands_of_a_section_are_those_of_the_zones_it_runs_through():
    found = inspection()
    w = whiskers(found, found.sections[1])
    at_edge = w.t < found.tolerances.le_zone
    assert set(w.bounds[at_edge][:, 1]) == {0.04}
    assert set(w.bounds[~at_edge][:, 1]) == {0.05}
    out = found.tolerances.zones["leading edge"].excess(w.deviation[at_edge])
    np.testing.assert_allclose(np.maximum(w.excess[at_edge], 0.0), out)


def test_the_histogram_counts_every_point_once():
    found = inspection()
    counted = histogram(found, 0.02)
    assert counted.counts.sum() + counted.below + counted.above == (found.zone >= 0).sum()
    assert counted.below > 0
    assert counted.above > 0
    wide = histogram(found, 1.0)
    assert wide.beyond == ""
    for zone, row in zip(found.zones, wide.counts, strict=True):
        assert row.sum() == zone.points


def test_colours_are_blue_for_missing_metal_and_red_for_standing_out():
    missing, nominal, out = colours(np.array([-1.0, 0.0, 9.0]), 1.0)
    assert missing[2] > missing[0] + 0.2
    assert out[0] > out[2] + 0.2
    assert nominal.min() > 0.85
    np.testing.assert_allclose(colours(np.array([9.0]), 1.0), [MAP(1.0)[:3]])
    share = line_share(np.array([-1e-9, 0.0, 2.0]), 1.0)
    assert share[0] < 0.4
    assert share[1] > 0.6
    assert share[2] == 1.0


def test_the_scale_holds_the_widest_band_and_nearly_all_points():
    found = inspection()
    limit = limit_of(found)
    inside = np.abs(found.feet.distance[~found.feet.rim]) <= limit
    assert limit >= 0.05
    assert inside.mean() > 0.998
    far = replace(found, feet=replace(found.feet, distance=found.feet.distance + 7.0))
    assert 0.05 < limit_of(far) <= 0.2


@pytest.mark.parametrize("x", [1.0, 0.0123, 7.3e-5, 49.9, 0.15])
def test_round_numbers_are_next_to_what_they_round(x):
    assert x <= round_up(x) * (1 + 1e-12) <= 1.7 * x
    assert x / 2.6 <= round_down(x) <= x
