from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import product

import cadquery as cq
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from bladecad.brep.limits import Limits
from bladecad.brep.names import HUB, LEADING_EDGE, PRESSURE_SIDE, SUCTION_SIDE, TIP, TRAILING_EDGE
from bladecad.brep.solid import Solid, build_solid, sample_face
from bladecad.brep.witnesses import believe
from bladecad.errors import GeometryError, ToleranceError
from bladecad.surface.patch import SplinePatch
from tests.brep.blades import Ends, blade, moved, volume, with_poles

SHAPES: list[tuple[Ends, bool, bool]] = list(
    product(("planar", "cylinders"), (False, True), (False, True))
)


@cache
def built(ends: Ends, blunt_leading: bool = False, blunt_trailing: bool = False) -> Solid:
    sides = blade(ends=ends, blunt_leading=blunt_leading, blunt_trailing=blunt_trailing)
    return build_solid(*sides, volume=volume(*sides))


@pytest.mark.parametrize(("ends", "leading", "trailing"), SHAPES)
def test_every_edge_and_end_gives_a_solid_with_the_expected_topology(
    ends: Ends, leading: bool, trailing: bool
) -> None:
    solid = built(ends, leading, trailing)
    blunt = leading + trailing
    assert solid.witnesses.valid
    assert solid.witnesses.counts == (4 + 2 * blunt, 6 + 3 * blunt, 4 + blunt)
    assert solid.witnesses.euler == 2
    assert solid.witnesses.free_edges == 0
    assert solid.witnesses.edge_tolerance <= 1e-7
    assert (LEADING_EDGE in solid.faces) == leading
    assert (TRAILING_EDGE in solid.faces) == trailing


@pytest.mark.parametrize(("ends", "leading", "trailing"), SHAPES)
def test_the_kernel_finds_the_volume_of_the_quadrature(
    ends: Ends, leading: bool, trailing: bool
) -> None:
    assert built(ends, leading, trailing).witnesses.volume_error < 5e-9


def test_the_quadrature_knows_a_blade_whose_volume_is_known() -> None:
    """Area of the section is chord^2/4 times 1.1 pi thick; chord and thickness are linear in u."""
    chord, thick = np.poly1d([-8.0, 30.0]), np.poly1d([-0.03, 0.07])
    primitive = (chord * chord * thick).integ()
    known = 40.0 * 1.1 * np.pi / 4 * (primitive(1.0) - primitive(0.0))
    assert volume(*blade(sections=9, nodes=160)) == pytest.approx(known, rel=1e-6)


def test_planar_ends_get_planes_and_others_are_ruled() -> None:
    assert [built("planar").faces[end].geomType() for end in (HUB, TIP)] == ["PLANE"] * 2
    assert [built("cylinders").faces[end].geomType() for end in (HUB, TIP)] == ["BSPLINE"] * 2


def test_an_end_that_is_nearly_planar_is_dropped_onto_its_plane() -> None:
    sides = [
        with_poles(side, side.poles + 5e-5 * np.sin(7 * side.poles[..., :1]) * [0.0, 0.0, 1.0])
        for side in blade()
    ]
    solid = build_solid(*sides, volume=volume(*sides))
    assert solid.faces[HUB].geomType() == "PLANE"
    assert solid.witnesses.edge_tolerance <= 1e-6
    u, t = np.linspace(0, 1, 11), np.linspace(0, 1, 101)
    assert np.abs(sample_face(solid, SUCTION_SIDE, u, t) - sides[0](u, t)).max() < 1e-4
    ruled = build_solid(*sides, volume=volume(*sides), limits=Limits(planar=0))
    assert ruled.faces[HUB].geomType() == "BSPLINE"


def test_named_faces_are_the_faces_of_the_solid() -> None:
    for shape in SHAPES:
        solid = built(*shape)
        own = solid.shape.Faces()
        assert all(any(face.isSame(f) for f in own) for face in solid.faces.values())
        assert sum(face.Area() for face in solid.faces.values()) == pytest.approx(
            solid.witnesses.area, rel=1e-4
        )


def test_faces_look_outward() -> None:
    solid = built("planar")
    assert solid.faces[HUB].normalAt().z == pytest.approx(-1)
    assert solid.faces[TIP].normalAt().z == pytest.approx(1)
    assert solid.shape.isInside(cq.Vector(*_inner_point()))
    for name in (SUCTION_SIDE, PRESSURE_SIDE):
        face = solid.faces[name]
        foot = face.positionAt(0.4, 0.5)
        out = face.normalAt(foot)
        assert not solid.shape.isInside(foot + out * 0.01)
        assert solid.shape.isInside(foot - out * 0.01)


def _inner_point() -> list[float]:
    both = [side(np.array([0.5]), np.array([0.5])).ravel() for side in blade()]
    return list((both[0] + both[1]) / 2)


@pytest.mark.parametrize(("ends", "leading", "trailing"), [SHAPES[0], SHAPES[7]])
def test_the_kernel_surface_is_the_patch(ends: Ends, leading: bool, trailing: bool) -> None:
    suction, pressure = blade(ends=ends, blunt_leading=leading, blunt_trailing=trailing)
    solid = built(ends, leading, trailing)
    u, t = np.linspace(0, 1, 23), np.linspace(0, 1, 131)
    assert np.abs(sample_face(solid, SUCTION_SIDE, u, t) - suction(u, t)).max() < 1e-12
    assert np.abs(sample_face(solid, PRESSURE_SIDE, u, t) - pressure(u, t)).max() < 1e-12


def test_ruled_faces_run_from_suction_to_pressure() -> None:
    suction, pressure = blade(ends="cylinders", blunt_trailing=True)
    solid = built("cylinders", False, True)
    half, places = np.array([0.5]), np.linspace(0, 1, 17)
    middle = (suction(np.zeros(1), places) + pressure(np.zeros(1), places)) / 2
    assert np.abs(sample_face(solid, HUB, half, places) - middle).max() < 1e-12
    middle = (suction(places, np.ones(1)) + pressure(places, np.ones(1))) / 2
    assert np.abs(sample_face(solid, TRAILING_EDGE, places, half) - middle).max() < 1e-12


def test_only_spline_faces_that_exist_can_be_sampled() -> None:
    half = np.array([0.5])
    with pytest.raises(GeometryError, match="plane face has no parameters"):
        sample_face(built("planar"), HUB, half, half)
    with pytest.raises(GeometryError, match="no face TRAILING_EDGE, only SUCTION_SIDE"):
        sample_face(built("planar"), TRAILING_EDGE, half, half)


@settings(max_examples=8, deadline=None)
@given(
    angles=st.tuples(*[st.floats(-3.1, 3.1)] * 3),
    shift=st.tuples(*[st.floats(-500, 500)] * 3),
    ends=st.sampled_from(["planar", "cylinders"]),
)
def test_moving_then_building_is_building_then_moving(
    angles: tuple[float, ...], shift: tuple[float, ...], ends: Ends
) -> None:
    rotation = Rotation.from_euler("xyz", angles).as_matrix()
    sides = blade(ends=ends, blunt_trailing=True)
    there = build_solid(
        *(moved(side, rotation, np.array(shift)) for side in sides), volume=volume(*sides)
    )
    here = built(ends, False, True)
    assert there.witnesses.volume == pytest.approx(here.witnesses.volume, rel=1e-8)
    assert there.witnesses.area == pytest.approx(here.witnesses.area, rel=1e-6)
    assert list(there.faces) == list(here.faces)
    grid = np.linspace(0, 1, 9)
    points = sample_face(here, PRESSURE_SIDE, grid, grid) @ rotation.T + shift
    assert np.abs(sample_face(there, PRESSURE_SIDE, grid, grid) - points).max() < 1e-10


@pytest.mark.parametrize("shape", SHAPES)
def test_a_saw_through_the_blade_loses_nothing(shape: tuple[Ends, bool, bool]) -> None:
    solid = built(*shape)
    box = cq.Solid.makeBox(60, 60, 20, pnt=cq.Vector(-30, -30, 95))
    halves = [solid.shape.cut(box), solid.shape.intersect(box)]
    assert all(half.isValid() for half in halves)
    assert sum(half.Volume() for half in halves) == pytest.approx(solid.witnesses.volume, rel=1e-3)


def test_two_sections_are_enough() -> None:
    sides = blade(sections=2)
    assert build_solid(*sides, volume=volume(*sides)).witnesses.valid


def test_a_wrong_volume_is_not_believed() -> None:
    sides = blade()
    with pytest.raises(GeometryError, match=r"not believed: kernel volume 1330\.9.*0\.0099 apart"):
        build_solid(*sides, volume=1.01 * volume(*sides))


@pytest.mark.parametrize("wrong", [0.0, -1330.0, float("nan"), float("inf")])
def test_a_volume_that_is_none_is_refused(wrong: float) -> None:
    with pytest.raises(GeometryError, match="bound nothing"):
        build_solid(*blade(), volume=wrong)


def test_each_witness_can_speak_against_the_solid() -> None:
    good = built("planar").witnesses
    believe(good, Limits())
    for change, words in [
        ({"valid": False}, "check fails"),
        ({"counts": (4, 6, 5)}, r"not \(4, 6, 4\); V - E \+ F = 3"),
        ({"free_edges": 2}, "2 edges do not join"),
        ({"edge_tolerance": 1e-3}, "tolerance 0.001 mm is above"),
        ({"volume": -good.volume}, "apart"),
    ]:
        with pytest.raises(GeometryError, match=words):
            believe(replace(good, **change), Limits())


def test_coinciding_sides_are_refused() -> None:
    suction, _ = blade()
    with pytest.raises(GeometryError, match=r"area of .* coincide"):
        build_solid(suction, suction, volume=1.0)


def test_sides_on_other_knots_are_refused() -> None:
    with pytest.raises(GeometryError, match="do not share knots"):
        build_solid(blade()[0], blade(nodes=30)[1], volume=1.0)


def test_crossing_sides_are_refused_with_the_place() -> None:
    suction, pressure = blade()
    poles = np.array(pressure.poles)
    poles[3, 15:20] = 2 * suction.poles[3, 15:20] - poles[3, 15:20]
    with pytest.raises(GeometryError, match=r"u = 0\.[3-6]\d+: .* cross.* t = 0\.[34]"):
        build_solid(suction, with_poles(pressure, poles), volume=1.0)


def test_a_slanted_hollow_cut_is_no_crossing() -> None:
    """At equal t one side is already on the cut, running back, while the other is still coming."""
    t = np.array([0.0, 0.0, 0.3, 0.8, 0.9, 1.0, 1.0])
    suction = np.array([[0, 0], [5, 1.5], [10, 1.0], [10.2, 0.5], [10.2, 0]])
    pressure = np.array([[0, 0], [5, -1.5], [10.3, -1.05], [10.6, -1.0], [10.2, 0]])
    ends = np.array([0.0, 0.0, 1.0, 1.0])
    sides = [
        SplinePatch(np.stack([np.insert(line, 2, z, axis=1) for z in (0.0, 5.0)]), ends, t, 1, 1)
        for line in (suction, pressure)
    ]
    loop = np.concatenate([suction, pressure[-2:0:-1]])
    x, y = loop.T
    area = 0.5 * abs(x @ np.roll(y, -1) - y @ np.roll(x, -1))
    solid = build_solid(sides[0], sides[1], volume=5.0 * area)
    assert solid.witnesses.valid


def test_a_swapped_section_is_refused() -> None:
    suction, pressure = blade()
    first, second = np.array(suction.poles), np.array(pressure.poles)
    first[4:], second[4:] = pressure.poles[4:], suction.poles[4:]
    with pytest.raises(GeometryError, match=r"cross|change places"):
        build_solid(with_poles(suction, first), with_poles(pressure, second), volume=1.0)


def test_an_edge_neither_shared_nor_blunt_is_refused() -> None:
    suction, pressure = blade()
    poles = np.array(pressure.poles)
    poles[:, -1] += 1e-6
    with pytest.raises(GeometryError, match=r"trailing edge: the sides are .* mm apart at u"):
        build_solid(suction, with_poles(pressure, poles), volume=1.0)


def test_a_ruled_end_that_folds_is_refused() -> None:
    """The pressure line turns back for a while, at half the pace of the suction line."""
    suction, pressure = blade(ends="cylinders")
    column = np.arange(42.0)
    column[15:21] = [16.5, 18.5, 20.0, 19.5, 19.0, 19.5]
    before = column.astype(int)
    weight = (column - before)[:, None]
    poles = pressure.poles[:, before] * (1 - weight)
    poles += pressure.poles[:, np.minimum(before + 1, 41)] * weight
    with pytest.raises(GeometryError, match="HUB cap folds over itself at t"):
        build_solid(suction, with_poles(pressure, poles), volume=1.0)


def test_kernel_exceptions_become_ours_and_keep_the_cause() -> None:
    suction, pressure = blade()
    knots = np.array(suction.knots_t)
    knots[20:25] = knots[22]
    torn = [SplinePatch(s.poles, s.knots_u, knots, 3, 3) for s in (suction, pressure)]
    with pytest.raises(GeometryError, match="kernel failed while closing") as caught:
        build_solid(*torn, volume=1.0)
    assert caught.value.__cause__ is not None


def test_limits_are_lengths() -> None:
    with pytest.raises(ToleranceError, match=r"Limits\.gap = -1"):
        Limits(gap=-1)
