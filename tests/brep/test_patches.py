from __future__ import annotations

from pathlib import Path

import cadquery as cq
import numpy as np
import pytest

from bladecad.brep.names import HUB, PRESSURE_SIDE, SUCTION_SIDE, TIP
from bladecad.brep.patches import joined, read_faces
from bladecad.brep.reread import read_step
from bladecad.brep.solid import build_solid
from bladecad.errors import ExportError
from bladecad.export.cad.step import write_step
from tests.brep.blades import blade, volume


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One blade as bladecad writes it, and the same without a name on any face."""
    path = tmp_path_factory.mktemp("step")
    sides = blade()
    solid = build_solid(*sides, volume=volume(*sides))
    write_step(solid, path / "named.step", name="fan")
    cq.exporters.export(cq.Workplane(solid.shape), str(path / "plain.step"))
    return path


def test_the_faces_of_a_blade_are_the_patches_it_was_made_of(folder: Path) -> None:
    found = read_faces(folder / "named.step")
    u, t = np.linspace(0, 1, 7), np.linspace(0, 1, 31)
    for name, patch in zip((SUCTION_SIDE, PRESSURE_SIDE), blade(), strict=True):
        again = found.patch(name)
        assert again is not None
        np.testing.assert_allclose(again.poles, patch.poles, atol=1e-9)
        np.testing.assert_allclose(again.knots_t, patch.knots_t, atol=1e-12)
        np.testing.assert_array_equal(again.weights, 1.0)
        np.testing.assert_allclose(again(u, t), patch(u, t), atol=1e-9)
    assert {face.name for face in found.faces} == {SUCTION_SIDE, PRESSURE_SIDE, HUB, TIP}


def test_planes_cut_by_an_outline_have_no_patch(folder: Path) -> None:
    found = read_faces(folder / "named.step")
    assert found.patch(HUB) is None
    assert found.patch(TIP) is None
    assert found.patch("nobody") is None


@pytest.mark.parametrize("name", ["named", "plain"])
def test_the_triangles_close_the_blade_and_face_outwards(name: str, folder: Path) -> None:
    found = read_faces(folder / f"{name}.step", chord_error=0.002)
    vertices, triangles = found.mesh
    corners = vertices[triangles]
    inside = np.einsum("kx,kx->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2])) / 6
    assert inside == pytest.approx(volume(*blade()), rel=2e-3)
    assert len(joined(found.faces[:2])[1]) == sum(len(f.triangles) for f in found.faces[:2])


def test_faces_without_a_name_are_counted(folder: Path) -> None:
    found = read_faces(folder / "plain.step")
    assert [face.name for face in found.faces] == [f"face {k}" for k in (1, 2, 3, 4)]
    assert sum(face.patch is not None for face in found.faces) == 2
    assert read_step(folder / "plain.step").faces == {}


def test_other_surfaces_become_rational_patches_and_rectangles_are_cut_out(tmp_path: Path) -> None:
    tube = cq.Workplane().circle(5.0).extrude(20.0)
    cq.exporters.export(tube, str(tmp_path / "tube.step"))
    patches = [face.patch for face in read_faces(tmp_path / "tube.step").faces if face.patch]
    (wall,) = patches
    u = np.linspace(wall.knots_u[0], wall.knots_u[-1], 60)
    t = np.linspace(wall.knots_t[0], wall.knots_t[-1], 5)
    X = wall(u, t)
    np.testing.assert_allclose(np.linalg.norm(X[..., :2], axis=-1), 5.0, atol=1e-9)
    assert np.ptp(X[..., 2]) == pytest.approx(20.0)
    assert np.ptp(wall.weights) > 0.0


def test_a_face_with_a_hole_has_no_patch_but_triangles(tmp_path: Path) -> None:
    plate = cq.Workplane().box(20, 10, 2).faces(">Z").workplane().hole(3.0)
    cq.exporters.export(plate, str(tmp_path / "plate.step"))
    found = read_faces(tmp_path / "plate.step")
    trimmed = [face for face in found.faces if face.patch is None]
    assert len(trimmed) == 2
    assert all(len(face.triangles) > 4 and face.chord_error < 1e-9 for face in trimmed)


def test_lengths_are_scaled_on_demand(folder: Path) -> None:
    one, ten = (read_faces(folder / "named.step", scale=s).patch(SUCTION_SIDE) for s in (1.0, 10.0))
    np.testing.assert_allclose(ten.poles, 10.0 * one.poles, atol=1e-9)


@pytest.mark.parametrize("content", [b"", b"solid nobody"])
def test_what_is_no_step_is_refused(content: bytes, tmp_path: Path) -> None:
    (tmp_path / "a.step").write_bytes(content)
    with pytest.raises(ExportError, match=r"a\.step cannot be read as STEP"):
        read_faces(tmp_path / "a.step")
