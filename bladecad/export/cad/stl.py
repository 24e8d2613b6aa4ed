"""STL for printing and viewing: one closed solid, binary, in mm."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any, final

from bladecad.errors import ExportError
from bladecad.surface.triangulate import BladeMesh
from bladecad.written import beside


@final
@dataclass(frozen=True)
class StlFile:
    """What trimesh finds in an STL file.

    triangles  : their number
    watertight : closed, and wound one way
    volume     : mm^3
    """

    triangles: int
    watertight: bool
    volume: float


def write_stl(mesh: BladeMesh, path: str | os.PathLike[str]) -> StlFile:
    """Write a blade as binary STL, or nothing at all, and return what was read back.

    Parameters
    ----------
    mesh : BladeMesh
    path : path
        Replaced when it exists; written beside first, read back, and then renamed.

    Raises
    ------
    ExportError
        If the file cannot be written, or is not the same closed mesh once read back.

    Notes
    -----
    STL has single precision: at 300 mm from the origin a vertex moves by up to 15 nm. Vertices that
    are one stay one, for they are rounded alike.
    """
    import trimesh

    with beside(path) as file:
        body: Any = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
        file.write_bytes(body.export(file_type="stl"))
        again = read_stl(file)
        _confirm(again, len(mesh.triangles))
    return again


def read_stl(path: str | os.PathLike[str]) -> StlFile:
    """Read an STL file with trimesh, equal vertices merged."""
    import trimesh

    mesh: Any = trimesh.load_mesh(path, file_type="stl")
    closed = bool(mesh.is_watertight and mesh.is_winding_consistent)
    return StlFile(len(mesh.faces), closed, float(mesh.volume))


def _confirm(again: StlFile, triangles: int) -> None:
    if not again.watertight or again.triangles != triangles:
        raise ExportError(
            f"the STL read back has {again.triangles} of {triangles} triangles and is "
            f"{'closed' if again.watertight else 'not closed'}; ask for a larger --chord-error"
        )
