"""An offset is as far from the blade as was asked for, everywhere, or refused."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from bladecad.cam.offset import offset_loft
from bladecad.cam.parallel import Parallel, unit_derivatives
from bladecad.cam.variant import Variant, varied
from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.deviation.nearest.skin import search
from bladecad.errors import GeometryError, ToleranceError
from bladecad.surface.blade import normals
from bladecad.surface.loft import SIDES
from bladecad.surface.triangulate import triangulate
from bladecad.surface.volume import ruled, volume
from tests.cam.blades import good, tube, waisted
from tests.surface.test_shapes import cone, lens

U, T = np.linspace(0.0, 1.0, 33), np.linspace(0.0, 1.0, 65)


@pytest.mark.parametrize("distance", [2.0, -0.3])
def test_a_tube_offset_is_a_tube(distance):
    found = offset_loft(tube(10.0, 10.0), distance)
    radius = np.array(
        [np.hypot(*np.moveaxis(p(U, T)[..., :2], -1, 0)) for p in (found.suction, found.pressure)]
    )
    np.testing.assert_allclose(radius, 10.0 + distance, atol=5e-4)
    assert volume(found.suction, found.pressure) == pytest.approx(
        np.pi * (10.0 + distance) ** 2 * 40.0, rel=2e-4
    )


@pytest.mark.parametrize("distance", [0.3, -0.08])
def test_another_program_finds_the_distance_between_offset_and_blade(distance):
    blade = good()
    found = offset_loft(blade, distance)
    mesh = triangulate(blade, chord_error=2e-3)
    body = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
    u, t = np.linspace(0.2, 0.8, 5), np.linspace(0.0, 1.0, 23)
    for patch in (found.suction, found.pressure):
        points = patch(u, t).reshape(-1, 3)
        away = -trimesh.proximity.signed_distance(body, points)
        np.testing.assert_allclose(away, distance, atol=mesh.chord_error + 5e-4)
    assert found.error <= 5e-4


def test_the_error_told_is_no_smaller_than_what_the_parallel_surface_says():
    blade, distance = good(), 0.3
    found, exact = offset_loft(blade, distance), Parallel(blade, distance)
    for side, patch in zip(SIDES, (found.suction, found.pressure), strict=True):
        n = normals(blade, side, U, T)
        along = np.einsum("utx,utx->ut", patch(U, T) - exact(side, U, T), n)
        assert np.abs(along).max() <= 1.05 * found.error + 1e-9


def test_sides_of_an_offset_share_edge_lines_and_tangents():
    found = offset_loft(good(), 0.3)
    for end in (0.0, 1.0):
        at = np.array([end])
        S, P = (patch(U, at, 0, 1)[:, 0] for patch in (found.suction, found.pressure))
        column = int(-end)
        np.testing.assert_array_equal(
            found.suction.poles[:, column], found.pressure.poles[:, column]
        )
        cos = np.einsum("ux,ux->u", S, -P) / np.linalg.norm(S, axis=1) / np.linalg.norm(P, axis=1)
        assert np.degrees(np.arccos(np.clip(cos, -1.0, 1.0))).max() < 0.01


def test_offset_and_back_through_the_volume_of_a_layer():
    """V(d) - V(0) of an uncapped blade is close to the area times d, Steiner's formula."""
    blade = good()
    inside = [volume(*_sides(offset_loft(blade, d))) for d in (-0.02, 0.02)]
    mesh = triangulate(blade, chord_error=5e-3)
    faces = np.concatenate([mesh.faces["SUCTION_SIDE"], mesh.faces["PRESSURE_SIDE"]])
    area = trimesh.Trimesh(mesh.vertices, faces, process=False).area
    assert inside[1] - inside[0] == pytest.approx(0.04 * area, rel=1e-2)


def _sides(found):
    return found.suction, found.pressure


@pytest.mark.parametrize(
    ("blade", "distance", "said"),
    [
        (lambda: tube(10.0, 2.0), -0.5, r"(leading|trailing) edge at .* convex radius of 0.4 mm"),
        (lambda: varied(good(), Variant(scale=0.2)), -0.3, "convex radius"),
        (lambda: lens(), 0.3, "edge is sharp"),
        (lambda: waisted(), 25.0, r"side at .* t = 0.500.* concave radius of 23.81 mm"),
    ],
)
def test_an_offset_that_would_cross_itself_is_refused(blade, distance, said):
    with pytest.raises(GeometryError, match=said):
        offset_loft(blade(), distance)


def test_a_blade_thinner_than_twice_the_offset_is_refused_though_it_bends_gently():
    """The waist is 1.2 mm thick and concave there; the edges have a radius of 0.9 mm."""
    assert offset_loft(waisted(), -0.5).error < 5e-4
    with pytest.raises(GeometryError, match=r"suction side at .* t = 0.500.* room for 0.6 mm"):
        offset_loft(waisted(), -0.7)


@pytest.mark.parametrize("distance", [0.3, -0.3])
def test_a_plate_with_cut_off_edges_grows_all_round(distance):
    """30 x 3 mm with square corners: the faces of the edges get the offset, corners a mitre."""
    plate = lens(thick=1e-9, taper=0.0, blunt=True, sections=2)
    found = offset_loft(plate, distance)
    corners = [[-15.0 - distance, 1.5 + distance], [15.0 + distance, 1.5 + distance]]
    for u in (0, -1):
        np.testing.assert_allclose(found.suction.poles[u, [0, -1], :2], corners, atol=1e-6)
    assert volume(found.suction, found.pressure) == pytest.approx(
        40.0 * (30.0 + 2 * distance) * (3.0 + 2 * distance), rel=1e-6
    )


@pytest.mark.parametrize("distance", [0.3, -0.3])
def test_faces_of_cut_off_edges_of_a_twisted_blade_are_at_the_distance_too(distance):
    blade = varied(lens(blunt=True), Variant(untwist=15.0))
    found = offset_loft(blade, distance)
    assert found.error < 1e-3
    face, u = ruled(found.suction, found.pressure, 1, -1), np.linspace(0.1, 0.9, 9)
    points = face(u, np.linspace(0.25, 0.75, 5)).reshape(-1, 3)
    away = search(nominal_of(blade).sides, points).distance
    np.testing.assert_allclose(away, distance, atol=1e-3)


def test_a_face_at_an_acute_angle_is_refused():
    """Sheared by 2 to 1 the faces of the edges stand at 27 degrees to the sides."""
    blade, shear = lens(thick=1e-9, taper=0.0, blunt=True), np.eye(3)
    shear[1, 0] = 2.0
    sides = [
        replace(s, coefficients=s.coefficients @ shear) for s in (blade.suction, blade.pressure)
    ]
    with pytest.raises(GeometryError, match="acute"):
        offset_loft(replace(blade, suction=sides[0], pressure=sides[1]), 0.3)


def test_creases_are_refused():
    with pytest.raises(GeometryError, match="creases"):
        offset_loft(lens(law="linear", blunt=True), 0.1)


@pytest.mark.parametrize("distance", [0.0, np.nan, np.inf])
def test_no_offset_is_refused(distance):
    with pytest.raises(ToleranceError, match="none"):
        offset_loft(cone(), distance)


def test_derivatives_of_unit_vectors_are_those_of_differences():
    t, h = np.linspace(0.1, 1.0, 7), 1e-4

    def N(t):
        return np.column_stack([1.0 + t**2, np.sin(t), t**3])

    def n(t):
        return N(t) / np.linalg.norm(N(t), axis=1)[:, None]

    N1 = np.column_stack([2.0 * t, np.cos(t), 3.0 * t**2])
    N2 = np.column_stack([2.0 + 0 * t, -np.sin(t), 6.0 * t])
    found = unit_derivatives(np.array([N(t), N1, N2]))
    np.testing.assert_allclose(found[1], (n(t + h) - n(t - h)) / (2 * h), atol=1e-7)
    np.testing.assert_allclose(found[2], (n(t + h) - 2 * n(t) + n(t - h)) / h**2, atol=1e-6)
