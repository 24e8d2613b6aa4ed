"""Sides divided into zones: the same surface, smooth where it was, and told where it is not."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bladecad.errors import GeometryError
from bladecad.surface.blade import EdgeKind
from bladecad.surface.cutting import cut, joined, matched, turned_round
from bladecad.surface.loft import Loft, loft
from bladecad.surface.patch import SplinePatch
from bladecad.surface.zone_ends import ABREAST, edge_kind
from bladecad.surface.zones import Faces, Zone, divide
from tests.brep.blades import blade, with_poles
from tests.deviation.scanned import blade as scanned
from tests.export.products import small

U = np.linspace(0.0, 1.0, 9)


@cache
def lofted() -> Loft:
    return loft(small().surface, tolerance=1e-3)


def sharp() -> tuple[SplinePatch, SplinePatch]:
    """A trailing edge with a corner: the poles beside it are moved apart."""
    suction, pressure = blade()
    poles = np.array(suction.poles)
    poles[:, -2] += 0.4 * (poles[:, -3] - poles[:, -2])
    return with_poles(suction, poles), pressure


@settings(max_examples=30, deadline=None)
@given(ends=st.tuples(st.floats(0.0, 0.45), st.floats(0.55, 1.0)))
def test_a_part_is_the_patch_itself(ends: tuple[float, float]) -> None:
    whole, (first, last) = blade()[0], ends
    part = cut(whole, first, last)
    v = np.linspace(0.0, 1.0, 83)
    assert np.abs(part(U, v) - whole(U, first + (last - first) * v)).max() < 1e-12
    assert part.knots_t[3] == 0.0
    assert part.knots_t[-4] == 1.0


def test_a_patch_turned_round_runs_backwards() -> None:
    whole, t = blade()[0], np.linspace(0.0, 1.0, 33)
    assert np.abs(turned_round(whole)(U, t) - whole(U, 1.0 - t)).max() < 1e-12
    np.testing.assert_array_equal(turned_round(turned_round(whole)).poles, whole.poles)


def test_no_trace_of_a_joint_remains() -> None:
    """The joint is a simple knot, so the joined patch is C2 there; and it is what it joins."""
    first, second, moved = matched(turned_round(blade()[0]), blade()[1], allowed=1e-4)
    one = joined(first, second)
    inner, times = np.unique(one.knots_t[4:-4], return_counts=True)
    assert times.max() == 1
    assert 0.5 in inner
    w = np.linspace(0.0, 0.5, 60)
    assert np.abs(one(U, w) - first(U, 2 * w)).max() < 1e-12
    assert np.abs(one(U, 0.5 + w) - second(U, 2 * w)).max() < 1e-12
    assert 0 < moved < 1e-6


def test_patches_that_meet_c2_stay_and_others_move_as_far_as_is_said() -> None:
    first, second, _ = matched(turned_round(blade()[0]), blade()[1], allowed=1e-4)
    assert matched(first, second, allowed=1e-4)[2] < 1e-12
    poles = np.array(second.poles)
    poles[3, 1] += [0.0, 0.01, 0.0]
    bent = with_poles(second, poles)
    a, b, moved = matched(first, bent, allowed=1.0)
    w = np.linspace(0.0, 1.0, 400)
    away = [np.linalg.norm(x(U, w) - y(U, w), axis=-1).max() for x, y in ((a, first), (b, bent))]
    assert 1e-3 < max(away) <= moved < 0.01
    assert matched(a, b, allowed=1e-4)[2] < 1e-12


def test_patches_on_other_knots_are_not_joined() -> None:
    with pytest.raises(GeometryError, match="knots that mirror each other"):
        joined(blade()[0], blade(nodes=30)[1])


@pytest.mark.parametrize("faces", [2, 4, 1])
def test_the_zones_cover_both_sides_once(faces: int) -> None:
    one = lofted()
    division = divide(one.suction, one.pressure, faces, allowed=1e-4)
    covered = {"suction": 0.0, "pressure": 0.0}
    for zone in division.zones:
        for stretch in zone.stretches:
            covered[stretch.side] += abs(stretch.last - stretch.first)
        assert _astray(zone, one) <= division.moved + 1e-12
    assert covered == pytest.approx({"suction": 1.0, "pressure": 1.0})
    assert division.moved < 1e-9


def _astray(zone: Zone, one: Loft) -> float:
    """Largest distance of a zone from the sides it covers, mm."""
    sides, parts = {"suction": one.suction, "pressure": one.pressure}, len(zone.stretches)
    s = np.linspace(0.0, 1.0, 101)
    return max(
        float(
            np.linalg.norm(
                zone.patch(U, (k + s) / parts) - sides[x.side](U, x.first + (x.last - x.first) * s),
                axis=-1,
            ).max()
        )
        for k, x in enumerate(zone.stretches)
    )


@pytest.mark.parametrize("kind", ["round", "blunt"])
@pytest.mark.parametrize("faces", [4, 1])
def test_both_sides_keep_their_knots_to_the_last_bit(faces: Faces, kind: EdgeKind) -> None:
    """Else a border between zones is a knot of one side and none of the other."""
    one = loft(scanned(kind), tolerance=1e-3)
    division = divide(one.suction, one.pressure, faces, allowed=1e-4)
    for side in (division.suction, division.pressure):
        np.testing.assert_array_equal(side.knots_t, one.suction.knots_t)
    assert all(_astray(zone, one) <= division.moved + 1e-12 for zone in division.zones)


def test_zones_of_edges_end_where_the_sides_run_abreast() -> None:
    one = lofted()
    for zone in divide(one.suction, one.pressure, 4, allowed=1e-4).zones[2:]:
        ends = np.array([0.0, 1.0])
        along = zone.patch(U, ends, 0, 1)
        size = np.linalg.norm(along, axis=-1)
        angle = np.pi - np.arccos(np.einsum("ux,ux->u", along[:, 0], along[:, 1]) / size.prod(1))
        assert angle.max() <= ABREAST
        lengths = np.linalg.norm(np.diff(zone.patch(U, np.linspace(0, 1, 300)), axis=1), axis=-1)
        assert lengths.sum(1).max() < 0.2 * 55.0


@pytest.mark.parametrize("faces", [4, 1])
def test_no_patch_breaks_inside_and_all_share_their_knots_along_the_span(faces: int) -> None:
    one = lofted()
    for zone in divide(one.suction, one.pressure, faces, allowed=1e-4).zones:
        knots = zone.patch.knots_t
        assert np.unique(knots[4:-4], return_counts=True)[1].max() == 1
        np.testing.assert_array_equal(zone.patch.knots_u, one.suction.knots_u)


def test_edges_are_told_apart() -> None:
    assert edge_kind(*blade(), 0) == "round"
    assert edge_kind(*blade(blunt_leading=True), 0) == "blunt"
    assert edge_kind(*sharp(), -1) == "sharp"


def test_blunt_and_sharp_edges_have_no_zone() -> None:
    for sides in (blade(blunt_trailing=True), sharp()):
        parts = [zone.part for zone in divide(*sides, 4, allowed=1e-4).zones]
        assert parts == ["suction", "pressure", "leading"]
    parts = [zone.part for zone in divide(*blade(blunt_leading=True), 4, allowed=1e-4).zones]
    assert parts == ["suction", "pressure", "trailing"]
    stretches = divide(*blade(blunt_leading=True), 1, allowed=1e-4).zones[0].stretches
    assert [(s.first, s.last) for s in stretches] == [(0.0, 1.0), (1.0, 0.0)]


def test_no_single_patch_runs_round_two_blunt_edges() -> None:
    sides = blade(blunt_leading=True, blunt_trailing=True)
    with pytest.raises(GeometryError, match="blunt leading and a blunt trailing edge"):
        divide(*sides, 1, allowed=1e-4)


def bent(column: int) -> SplinePatch:
    """The pressure side with a pole near the leading edge off: 1 takes C1 from it, 2 takes C2."""
    pressure = blade()[1]
    poles = np.array(pressure.poles)
    poles[:, column] += 0.02 * (poles[:, column] - poles[:, column - 1])
    return with_poles(pressure, poles)


def test_sides_that_meet_less_than_c2_are_joined_c1_and_stay_as_they_are() -> None:
    division = divide(blade()[0], bent(2), 4, allowed=1e-4)
    assert division.moved < 1e-4
    leading, trailing = (zone.patch.knots_t for zone in division.zones[2:])
    assert np.unique(leading[4:-4], return_counts=True)[1].tolist().count(2) == 1
    assert np.unique(trailing[4:-4], return_counts=True)[1].max() == 1
    patch, u = division.zones[2].patch, np.linspace(0, 1, 9)
    before, behind = (patch(u, np.array([0.5 + s]), 0, 1)[:, 0] for s in (-1e-12, 1e-12))
    assert np.abs(before - behind).max() < 1e-6 * np.abs(before).max()


def test_patches_too_coarse_for_zones_are_refused() -> None:
    with pytest.raises(GeometryError, match="of 6 poles along t are too coarse"):
        divide(*blade(nodes=4), 4, allowed=10.0)


def test_sides_that_meet_less_than_c1_are_refused_with_the_number() -> None:
    with pytest.raises(
        GeometryError, match=r"leading edge, but not C1: .* 0\.00\d+ mm, 0\.0001 mm"
    ):
        divide(blade()[0], bent(1), 4, allowed=1e-4)
