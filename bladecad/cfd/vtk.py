"""Meshes for ParaView: structured blocks as .vts, triangles as .vtp, with what is known there."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Points
from bladecad.errors import ExportError
from bladecad.meshes.blocks import Block
from bladecad.meshes.named import NamedMesh
from bladecad.written import beside

Data = Mapping[str, NDArray[Any]]


def write_vts(block: Block, path: str | os.PathLike[str]) -> None:
    """Write a block as a VTK structured grid, mm, with point data u, t and curvature.

    Raises
    ------
    ExportError
        If the file cannot be written.
    """
    from vtkmodules.vtkCommonDataModel import vtkStructuredGrid
    from vtkmodules.vtkIOXML import vtkXMLStructuredGridWriter

    nj, ni, _ = block.points.shape
    grid = vtkStructuredGrid()
    grid.SetDimensions(ni, nj, 1)
    grid.SetPoints(_points(block.points.reshape(-1, 3)))
    data = {"u": block.u, "t": block.t, "curvature": block.curvature}
    _attach(grid.GetPointData(), {name: x.ravel() for name, x in data.items()})
    _write(vtkXMLStructuredGridWriter(), grid, path)


def write_vtp(mesh: NamedMesh, path: str | os.PathLike[str], point_data: Data) -> None:
    """Write triangles as VTK poly data, mm, with data of every vertex; cell data "patch".

    "patch" is the number of the patch; their names stand in the field data "patches".

    Raises
    ------
    ExportError
        If the file cannot be written.
    """
    from vtkmodules.util.numpy_support import numpy_to_vtkIdTypeArray
    from vtkmodules.vtkCommonCore import vtkStringArray
    from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
    from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter

    body, cells, names = vtkPolyData(), vtkCellArray(), vtkStringArray()
    k = mesh.triangles
    cells.SetData(3, numpy_to_vtkIdTypeArray(np.ascontiguousarray(k).ravel(), deep=True))
    body.SetPoints(_points(mesh.vertices))
    body.SetPolys(cells)
    _attach(body.GetPointData(), point_data)
    counts = [len(patch) for patch in mesh.patches.values()]
    patch = np.repeat(np.arange(len(counts), dtype=np.int32), counts)
    _attach(body.GetCellData(), {"patch": patch})
    names.SetName("patches")
    for name in mesh.patches:
        names.InsertNextValue(name)
    body.GetFieldData().AddArray(names)
    _write(vtkXMLPolyDataWriter(), body, path)


def _points(X: Points) -> Any:
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonCore import vtkPoints

    points = vtkPoints()
    points.SetDataTypeToDouble()
    points.SetData(numpy_to_vtk(np.ascontiguousarray(X), deep=True))
    return points


def _attach(to: Any, data: Data) -> None:
    from vtkmodules.util.numpy_support import numpy_to_vtk

    for name, values in data.items():
        array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
        array.SetName(name)
        to.AddArray(array)


def _write(writer: Any, what: Any, path: str | os.PathLike[str]) -> None:
    with beside(path) as part:
        with part.open("wb"):
            pass  # says why a file cannot be written, which VTK does not
        writer.SetFileName(str(part))
        writer.SetInputData(what)
        if not writer.Write():
            raise ExportError(f"VTK does not write {path}")
