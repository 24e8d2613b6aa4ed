"""Files read again by the programs they are for."""

from __future__ import annotations

from pathlib import Path

import gmsh
import numpy as np
import pytest
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOParallel import vtkMultiBlockPLOT3DReader
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLStructuredGridReader

from bladecad.cfd.msh import write_msh
from bladecad.cfd.plot3d import write_plot3d
from bladecad.cfd.vtk import write_vtp, write_vts
from bladecad.errors import ExportError
from bladecad.meshes.blade import mesh_blade
from bladecad.meshes.blocks import blade_blocks
from bladecad.meshes.sizing import Sizing
from tests.meshes.blades import blade

ASKED = Sizing(4.0, 0.05)


def dimensions(grid) -> tuple[int, ...]:
    found = [0, 0, 0]
    grid.GetDimensions(found)
    return tuple(found)


@pytest.mark.parametrize("kind", ["round", "blunt"])
def test_gmsh_finds_every_patch_as_a_physical_surface(kind: str, tmp_path: Path):
    mesh = mesh_blade(blade(kind), ASKED).mesh
    write_msh(mesh, tmp_path / "blade.msh")
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(str(tmp_path / "blade.msh"))
        groups = {
            gmsh.model.getPhysicalName(2, tag): tag for _, tag in gmsh.model.getPhysicalGroups(2)
        }
        assert {*groups} == {*mesh.patches}
        tags, points, _ = gmsh.model.mesh.getNodes()
        assert np.array_equal(points.reshape(-1, 3)[np.argsort(tags)], mesh.vertices)
        for name, tag in groups.items():
            (entity,) = gmsh.model.getEntitiesForPhysicalGroup(2, tag)
            _, elements, nodes = gmsh.model.mesh.getElements(2, entity)
            assert np.array_equal(nodes[0].reshape(-1, 3) - 1, mesh.patches[name])
            gamma = gmsh.model.mesh.getElementQualities(elements[0], "gamma")
            assert gamma.min() > 0.05
    finally:
        gmsh.finalize()


@pytest.mark.parametrize("kind", ["round", "blunt"])
def test_plot3d_comes_back_bit_by_bit(kind: str, tmp_path: Path):
    blocks = blade_blocks(blade(kind), ASKED).blocks
    write_plot3d(blocks, tmp_path / "blade.xyz")
    reader = vtkMultiBlockPLOT3DReader()
    reader.SetXYZFileName(str(tmp_path / "blade.xyz"))
    reader.BinaryFileOff()
    reader.MultiGridOn()
    reader.DoublePrecisionOn()
    reader.Update()
    found = reader.GetOutput()
    assert found.GetNumberOfBlocks() == len(blocks)
    for i, block in enumerate(blocks):
        grid = found.GetBlock(i)
        assert dimensions(grid) == (*block.points.shape[1::-1], 1)
        points = vtk_to_numpy(grid.GetPoints().GetData())
        assert np.array_equal(points, block.points.reshape(-1, 3))


def test_a_structured_grid_has_u_t_and_curvature(tmp_path: Path):
    block = blade_blocks(blade(), ASKED).blocks[0]
    write_vts(block, tmp_path / "suction.vts")
    reader = vtkXMLStructuredGridReader()
    reader.SetFileName(str(tmp_path / "suction.vts"))
    reader.Update()
    grid = reader.GetOutput()
    assert dimensions(grid) == (*block.points.shape[1::-1], 1)
    assert np.array_equal(vtk_to_numpy(grid.GetPoints().GetData()), block.points.reshape(-1, 3))
    for name, known in (("u", block.u), ("t", block.t), ("curvature", block.curvature)):
        assert np.array_equal(vtk_to_numpy(grid.GetPointData().GetArray(name)), known.ravel())


def test_triangles_have_their_patch_and_what_is_given(tmp_path: Path):
    patches = mesh_blade(blade(), ASKED)
    write_vtp(patches.mesh, tmp_path / "blade.vtp", {"u": patches.u, "t": patches.t})
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(tmp_path / "blade.vtp"))
    reader.Update()
    body = reader.GetOutput()
    assert np.array_equal(vtk_to_numpy(body.GetPointData().GetArray("t")), patches.t)
    ids = vtk_to_numpy(body.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    assert np.array_equal(ids, patches.mesh.triangles)
    names = body.GetFieldData().GetAbstractArray("patches")
    patch = vtk_to_numpy(body.GetCellData().GetArray("patch"))
    for i, (name, triangles) in enumerate(patches.mesh.patches.items()):
        assert names.GetValue(i) == name
        assert np.array_equal(ids[patch == i], triangles)


def test_files_that_cannot_be_written_leave_nothing(tmp_path: Path):
    patches, nowhere = mesh_blade(blade(), ASKED), tmp_path / "none"
    blocks = blade_blocks(blade(), ASKED).blocks
    for write in (
        lambda: write_msh(patches.mesh, nowhere / "a.msh"),
        lambda: write_plot3d(blocks, nowhere / "a.xyz"),
        lambda: write_vts(blocks[0], nowhere / "a.vts"),
        lambda: write_vtp(patches.mesh, nowhere / "a.vtp", {}),
    ):
        with pytest.raises(ExportError, match="cannot be written: No such file"):
            write()
    assert not list(tmp_path.iterdir())
