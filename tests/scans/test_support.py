"""Holes of a scan are found; thin and uneven cover is none."""

from __future__ import annotations

import numpy as np
import pytest

from bladecad.deviation.nearest.project import project
from bladecad.scans.judging.support import find_gaps, support_of, supported
from tests.scans.truth import inside, nominal_for, scan_of, truth_surface

BLADES = ("synthetic", "synthetic-small", "rotor37")
HOLES = {
    "inner": ("suction", 0.4, 0.6, 0.3, 0.5),
    "slanting": ("pressure", 0.55, 0.95, 0.6, 0.7),
    "hub": ("pressure", -1.0, 0.1, 0.3, 0.5),
    "tip": ("pressure", 0.9, 2.0, 0.3, 0.5),
    "leading edge": ("suction", 0.3, 0.6, -1.0, 0.06),
    "trailing edge": ("pressure", 0.3, 0.5, 0.9, 2.0),
    "tip corner": ("suction", 0.85, 2.0, 0.85, 2.0),
    "all of a side": ("suction", -1.0, 2.0, -1.0, 2.0),
}


def feet_of(scan):
    return project(nominal_for(scan.surface), scan.to_truth(scan.points))


def area_of(surface, hole):
    side, *bounds = hole
    u0, u1, t0, t1 = np.clip(bounds, 0.0, 1.0)
    x = (np.arange(200) + 0.5) / 200
    u, t = u0 + (u1 - u0) * x, t0 + (t1 - t0) * x
    n = np.cross(surface(side, u, t, 1, 0), surface(side, u, t, 0, 1))
    return float(np.linalg.norm(n, axis=2).mean() * (u1 - u0) * (t1 - t0))


@pytest.mark.parametrize("edges", [1.0, 0.25])
@pytest.mark.parametrize("where", HOLES)
@pytest.mark.parametrize("name", BLADES)
def test_a_hole_is_found_with_its_place_and_area(name, where, edges):
    surface, hole = truth_surface(name), HOLES[where]
    scan = scan_of(surface, 200_000, sigma=0.01, hole=hole, edges=edges, pose="any")
    (gap,) = find_gaps(surface, feet_of(scan))
    wanted = area_of(surface, hole)
    assert abs(gap.area / wanted - 1) < 0.1
    bounds = np.clip(hole[1:], 0.0, 1.0)
    assert gap.side == hole[0]
    np.testing.assert_allclose([*gap.u, *gap.t], bounds, atol=0.02)
    middle = surface(gap.side, bounds[:2].mean(keepdims=True), bounds[2:].mean(keepdims=True))
    assert np.linalg.norm(gap.centre - middle[0, 0]) < 0.1 * np.sqrt(wanted)


COVERS = {
    "even": {},
    "a quarter at the edges": {"edges": 0.25},
    "a tenth at the edges": {"edges": 0.1},
    "crowded at the edges": {
        "density": lambda u, t: 0.03 + 0.97 * np.exp(-np.minimum(t, 1 - t) / 0.08)
    },
    "a twentieth before mid-chord": {"density": lambda u, t: np.where(t > 0.5, 1.0, 0.05)},
    "squares": {
        "density": lambda u, t: np.where(np.sin(40 * u) * np.sin(40 * t) > 0, 1.0, 0.1)
    },
    "a mesh": {"mesh": True},
}  # fmt: skip


@pytest.mark.parametrize("count", [2_000, 30_000, 200_000])
@pytest.mark.parametrize("cover", COVERS)
def test_thin_and_uneven_cover_is_no_gap(cover, count):
    surface = truth_surface("synthetic")
    scan = scan_of(surface, count, sigma=0.01, seed=count, **COVERS[cover])
    assert find_gaps(surface, feet_of(scan)) == ()


@pytest.mark.parametrize("kept", ["every fourth", "half at random"])
def test_a_hole_stays_what_it_is_when_points_are_left_out(kept):
    surface = truth_surface("rotor37")
    scan = scan_of(surface, 200_000, sigma=0.01, hole=HOLES["inner"], edges=0.25)
    feet = feet_of(scan)
    rng = np.random.default_rng(0)
    keep = rng.random(len(scan.points)) < 0.5
    keep = np.arange(len(keep)) % 4 == 0 if kept == "every fourth" else keep
    (all_of_it,), (found,) = find_gaps(surface, feet), find_gaps(surface, feet[keep])
    assert abs(found.area / all_of_it.area - 1) < 0.05


def test_two_holes_are_two_and_the_larger_comes_first():
    surface = truth_surface("synthetic")
    scan = scan_of(surface, 100_000, hole=HOLES["inner"])
    feet = feet_of(scan)
    second = ("pressure", 0.2, 0.5, 0.3, 0.6)
    gaps = find_gaps(surface, feet[~inside(second, feet.suction, feet.u, feet.t)])
    assert [gap.side for gap in gaps] == ["pressure", "suction"]
    assert gaps[0].area > gaps[1].area
    assert 0.0 < gaps[1].share < gaps[0].share < 0.1


def test_a_few_points_that_strayed_into_a_hole_do_not_hide_it():
    surface, hole = truth_surface("synthetic"), HOLES["inner"]
    full, holed = (feet_of(scan_of(surface, 100_000, hole=h)) for h in (None, hole))
    within = np.flatnonzero(inside(hole, full.suction, full.u, full.t))
    keep = ~inside(hole, full.suction, full.u, full.t)
    keep[within[:: len(within) // 4][:3]] = True
    (gap,), (empty,) = find_gaps(surface, full[keep]), find_gaps(surface, holed)
    assert abs(gap.area / empty.area - 1) < 0.1


def test_rows_of_a_measuring_machine_are_cover():
    surface = truth_surface("synthetic")
    full = feet_of(scan_of(surface, 400_000))
    rows = np.abs(full.u * 20 - np.rint(full.u * 20)) < 0.01
    assert find_gaps(surface, full[rows]) == ()


def test_places_are_told_on_any_grid():
    surface, hole = truth_surface("synthetic"), HOLES["inner"]
    feet = feet_of(scan_of(surface, 200_000, hole=hole))
    u, t = np.linspace(0.0, 1.0, 101), np.linspace(0.0, 1.0, 151)
    found = supported(surface, feet, "suction", u, t)
    U, T = np.meshgrid(u, t, indexing="ij")
    off = np.maximum(np.abs(U - 0.5) - 0.1, np.abs(T - 0.4) - 0.1)
    assert not found[off < -0.02].any()
    assert found[off > 0.02].all()
    assert supported(surface, feet, "pressure", u, t).all()


def test_no_point_at_all_is_a_gap_everywhere():
    surface = truth_surface("synthetic")
    feet = feet_of(scan_of(surface, 1_000))
    support = support_of(surface, feet[np.zeros(len(feet.u), bool)])
    assert len(support.gaps) == 2
    assert all(gap.share == 1.0 for gap in support.gaps)
