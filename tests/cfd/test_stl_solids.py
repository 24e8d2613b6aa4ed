from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import gmsh
import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from bladecad.cfd import stl_solids
from bladecad.cfd.fixed import fixed, parsed, scaled
from bladecad.cfd.stl_solids import places, read_stl_solids, write_stl_solids
from bladecad.errors import ExportError
from bladecad.meshes.blade import mesh_blade
from bladecad.meshes.named import NamedMesh
from bladecad.meshes.sizing import Sizing
from tests.meshes.blades import blade


def mesh(kind: str = "round") -> NamedMesh:
    return mesh_blade(blade(kind), Sizing(4.0, 0.05)).mesh


@pytest.mark.parametrize("kind", ["round", "blunt"])
def test_the_solids_are_the_patches_and_shared_vertices_the_same_text(kind: str, tmp_path: Path):
    written = mesh(kind)
    write_stl_solids(written, tmp_path / "blade.stl")
    text = (tmp_path / "blade.stl").read_text("ascii")
    names = [line.split()[1] for line in text.splitlines() if line.startswith("solid")]
    assert names == list(written.patches)
    words = {line for line in text.splitlines() if line.startswith("vertex")}
    assert len(words) == len(written.vertices)
    assert [p.name for p in tmp_path.iterdir()] == ["blade.stl"]


def test_another_program_finds_it_closed_in_metres(tmp_path: Path):
    written = mesh()
    write_stl_solids(written, tmp_path / "blade.stl")
    scene = trimesh.load_scene(tmp_path / "blade.stl", file_type="stl_ascii")
    whole = trimesh.util.concatenate(list(scene.geometry.values()))
    whole.merge_vertices(digits_vertex=12)
    assert whole.is_watertight
    assert whole.is_winding_consistent
    assert whole.volume == pytest.approx(1e-9 * written.volume, rel=1e-6)


def test_gmsh_reads_every_solid(tmp_path: Path):
    written = mesh()
    write_stl_solids(written, tmp_path / "blade.stl", unit="mm")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.merge(str(tmp_path / "blade.stl"))
        assert len(gmsh.model.getEntities(2)) == len(written.patches)
        points = gmsh.model.mesh.getNodes()[1].reshape(-1, 3)
    finally:
        gmsh.finalize()
    np.testing.assert_allclose(points.min(axis=0), written.vertices.min(axis=0), atol=1e-6)


def test_normals_point_out_of_the_metal(tmp_path: Path):
    write_stl_solids(mesh(), tmp_path / "blade.stl")
    rows = (tmp_path / "blade.stl").read_text().splitlines()
    normals = np.array([row.split()[2:] for row in rows if row.startswith("facet")], float)
    X = np.array([row.split()[1:] for row in rows if row.startswith("vertex")], float)
    X = X.reshape(-1, 3, 3)
    n = np.cross(X[:, 1] - X[:, 0], X[:, 2] - X[:, 0])
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    np.testing.assert_allclose(normals, n, atol=1e-4)
    assert np.einsum("kx,kx->", X[:, 0] - X.mean(axis=(0, 1)), normals) > 0


def test_what_is_read_back_must_be_what_was_written(tmp_path: Path, monkeypatch):
    written = mesh()
    write_stl_solids(written, tmp_path / "blade.stl")
    corners = read_stl_solids(tmp_path / "blade.stl")
    np.testing.assert_allclose(
        places(corners["blade_tip"]), written.vertices[written.patches["blade_tip"]], atol=1e-7
    )
    wrong = {**corners, "blade_tip": corners["blade_tip"] + 1}
    for again, words in ((wrong, '"blade_tip"'), ({}, r"has solids \[\]")):
        monkeypatch.setattr(stl_solids, "read_stl_solids", lambda _, again=again: again)
        with pytest.raises(ExportError, match=words):
            write_stl_solids(written, tmp_path / "other.stl")
    assert [p.name for p in tmp_path.iterdir()] == ["blade.stl"]


def test_vertices_that_would_be_one_as_printed_are_refused(tmp_path: Path):
    close = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1e-8, 0, 0]])
    thin = NamedMesh(close, {"a": np.array([[0, 1, 2], [3, 1, 2]])})
    with pytest.raises(ExportError, match=r"1 vertices are less than 0\.1 nm from another"):
        write_stl_solids(thin, tmp_path / "a.stl")
    named = replace(
        thin, vertices=2.0 * close + np.arange(4)[:, None], patches={"a b": thin.triangles}
    )
    with pytest.raises(ExportError, match='"a b" is no name for a patch'):
        write_stl_solids(named, tmp_path / "a.stl")
    assert not list(tmp_path.iterdir())


def test_a_folder_that_is_missing_and_a_file_that_is_no_stl_are_told(tmp_path: Path):
    with pytest.raises(ExportError, match="cannot be written: No such file"):
        write_stl_solids(mesh(), tmp_path / "none" / "a.stl")
    with pytest.raises(ExportError, match="cannot be read: No such file"):
        read_stl_solids(tmp_path / "a.stl")
    (tmp_path / "a.stl").write_text("solid a\nfacet normal\n")
    with pytest.raises(ExportError, match='solid "a" does not end'):
        read_stl_solids(tmp_path / "a.stl")


@given(st.lists(st.floats(-1e4, 1e4), min_size=1, max_size=20), st.integers(1, 10))
def test_numbers_are_written_as_python_writes_them(numbers: list[float], digits: int):
    x = scaled(np.array(numbers), digits)
    text = fixed(x, digits)
    assert np.array_equal(parsed(text), x)
    for row, number in zip(text, x / 10.0**digits, strict=True):
        assert float(bytes(row)) == pytest.approx(number, abs=0.01 * 10.0**-digits)
        assert len(bytes(row).split(b".")[1]) == digits


def test_numbers_too_long_are_refused_and_words_are_no_numbers():
    with pytest.raises(ExportError, match="cannot be written with 10 digits"):
        scaled(np.array([1e6]), 10)
    with pytest.raises(ExportError, match="no number"):
        parsed(np.frombuffer(b" 1.2e5", np.uint8).reshape(1, -1))
