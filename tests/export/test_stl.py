from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh

from bladecad.errors import ExportError
from bladecad.export.cad.stl import read_stl, write_stl
from tests.export.products import small


def test_stl_is_the_closed_mesh_in_millimetres(tmp_path: Path):
    mesh = small().mesh
    found = write_stl(mesh, tmp_path / "blade.stl")
    assert found == read_stl(tmp_path / "blade.stl")
    assert found.watertight
    assert found.triangles == len(mesh.triangles)
    assert found.volume == pytest.approx(mesh.volume, rel=1e-6)
    again = trimesh.load_mesh(tmp_path / "blade.stl")
    assert len(again.vertices) == len(mesh.vertices)
    np.testing.assert_allclose(again.bounds[0], mesh.vertices.min(axis=0), rtol=1e-6)


def test_a_mesh_with_a_hole_is_not_written(tmp_path: Path):
    mesh = small().mesh
    holed = replace(mesh, faces={name: k for name, k in mesh.faces.items() if name != "TIP"})
    with pytest.raises(ExportError, match="is not closed; ask for a larger --chord-error"):
        write_stl(holed, tmp_path / "blade.stl")
    assert not list(tmp_path.iterdir())


def test_stl_that_cannot_be_written_leaves_nothing(tmp_path: Path):
    with pytest.raises(ExportError, match=r"blade.stl cannot be written: No such file"):
        write_stl(small().mesh, tmp_path / "none" / "blade.stl")
