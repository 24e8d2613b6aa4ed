from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.deviation.nearest.project import project
from bladecad.errors import GeometryError, ToleranceError
from bladecad.fit.sidefit import SideFit
from bladecad.meshes.blade import mesh_blade
from bladecad.meshes.edges import edge_zones
from bladecad.meshes.sizing import Sizing, chordwise, largest_growth
from bladecad.surface.loft import loft
from bladecad.surface.volume import volume
from tests.cam.blades import tube
from tests.meshes.blades import KINDS, blade

ASKED = Sizing(size=3.0, chord_error=0.02)
ROUND = ["blade_suction", "blade_pressure", "blade_le", "blade_te", "blade_hub", "blade_tip"]


@pytest.mark.parametrize("kind", KINDS)
def test_a_blade_is_closed_in_named_patches_with_no_flat_triangle(kind: str):
    found = mesh_blade(blade(kind), ASKED)
    mesh = found.mesh
    assert mesh.open_edges == 0
    assert mesh.volume > 0
    assert len(np.unique(mesh.vertices, axis=0)) == len(mesh.vertices)
    assert np.array_equal(np.unique(mesh.triangles), np.arange(len(mesh.vertices)))
    edges = {"blade_le", "blade_te"} if kind != "sharp" else set()
    assert {*mesh.patches} == {*ROUND} - {"blade_le", "blade_te"} | edges
    for quality in found.quality.values():
        assert quality.smallest_area > 0
        assert quality.smallest_angle > 9.0
        assert quality.longest <= 2.0**0.5 * 1.2 * ASKED.size


@pytest.mark.parametrize("kind", ["round", "blunt"])
def test_triangles_are_as_near_to_the_blade_as_is_said(kind: str):
    """Against projection, which never met the mesh, on eleven places of every triangle."""
    surface = blade(kind)
    found = mesh_blade(surface, ASKED)
    assert found.chord_error <= ASKED.chord_error
    rng = np.random.default_rng(1)
    share = rng.dirichlet(np.ones(3), 11)
    X = np.einsum("sc,kcx->skx", share, found.mesh.vertices[found.mesh.triangles]).reshape(-1, 3)
    away = np.abs(project(nominal_of(surface), X, caps=True).distance)
    assert away.max() <= 1.1 * found.chord_error
    assert away.max() >= 0.5 * found.chord_error


@pytest.mark.parametrize("kind", ["round", "blunt"])
def test_the_volume_comes_to_that_of_the_blade_as_the_chord_error_falls(kind: str):
    surface = blade(kind)
    sides = loft(surface, tolerance=1e-4)
    true = volume(sides.suction, sides.pressure)
    errors = [
        abs(mesh_blade(surface, Sizing(50.0, chord, 3.0)).mesh.volume / true - 1.0)
        for chord in (0.08, 0.01)
    ]
    assert errors[1] < 0.2 * errors[0]  # linear in the chord error: 0.125
    assert errors[1] < 1e-3


def test_steps_grow_no_faster_than_asked_and_are_no_longer():
    surface = blade()
    for growth in (1.1, 1.3):
        asked = Sizing(2.0, 0.05, growth, edge=0.08)
        t = chordwise(surface, asked)
        assert largest_growth(t) <= growth * 1.001
        assert largest_growth(t) > 1.0 + 0.8 * (growth - 1.0)
        step = np.linalg.norm(np.diff(surface("suction", np.linspace(0, 1, 9), t), axis=1), axis=2)
        assert step.max() <= 2.0 * 1.001
        assert step[:, [0, -1]].max() <= 0.08 * growth
    assert len(chordwise(surface, Sizing(2.0, 0.05, 1.1, 0.08))) > len(t)


def test_edge_zones_end_where_the_edge_does():
    """Of a circle of radius r a zone would be all; of a blade it is a few radii of its edge."""
    surface = blade()
    (le, _), (te, _) = edge_zones(surface)
    length = np.linalg.norm(np.diff(surface("suction", np.array([0.0]), np.array([0.0, 1.0]))[0],
                                    axis=0))  # fmt: skip
    assert 0.2 < le * length < 2.0
    assert 0.2 < te * length < 2.0
    assert edge_zones(blade("blunt"))[1] == (0.0, 0.0)
    assert edge_zones(blade("sharp")) == ((0.0, 0.0), (0.0, 0.0))
    zones = mesh_blade(surface, ASKED).zones
    assert zones[0] == pytest.approx((le, te), abs=0.01)


def test_a_tube_has_the_area_of_a_tube():
    found = mesh_blade(tube(), Sizing(1.0, 0.01))
    area = sum(q.area for q in found.quality.values())
    assert area == pytest.approx(2 * np.pi * 10 * 40 + 2 * np.pi * 100, rel=1e-3)
    assert found.mesh.volume == pytest.approx(np.pi * 100 * 40, rel=2e-3)


def test_a_mirrored_blade_is_meshed_with_its_outside_out():
    mirror = np.array([1.0, -1.0, 1.0])
    surface = blade()
    sides = [SideFit(s.bases, s.coefficients * mirror) for s in (surface.suction, surface.pressure)]
    mirrored = mesh_blade(replace(surface, suction=sides[0], pressure=sides[1]), ASKED)
    assert mirrored.mesh.open_edges == 0
    assert mirrored.mesh.volume == pytest.approx(mesh_blade(surface, ASKED).mesh.volume, rel=1e-6)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        ({"size": 0.0}, "size of 0 mm"),
        ({"size": -1.0}, "size of -1 mm"),
        ({"size": float("nan")}, "size of nan mm"),
        ({"size": 1.0, "chord_error": 0.0}, "chord error of 0 mm"),
        ({"size": 1.0, "edge": -0.1}, "edge size of -0.1 mm"),
        ({"size": 1.0, "growth": 1.0}, "growth of 1 is asked; it must be above 1"),
        ({"size": 1.0, "aspect": 0.5}, "aspect of 0.5"),
    ],
)
def test_sizes_that_make_no_sense_are_refused(wrong: dict[str, float], words: str):
    with pytest.raises(ToleranceError, match=words):
        Sizing(**wrong)


def test_too_many_triangles_are_refused_before_they_are_made():
    with pytest.raises(
        GeometryError, match="takes more than 4,000,000 triangles; ask for a larger"
    ):
        mesh_blade(blade(), Sizing(0.01))


def test_sides_that_touch_are_refused():
    surface = blade()
    flat = replace(surface, pressure=surface.suction)
    with pytest.raises(GeometryError):
        mesh_blade(flat, ASKED)
