"""STL for printing and viewing: one closed solid, binary, in mm."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path
from typing import Any

from bladecad.errors import ExportError
from bladecad.surface.triangulate import BladeMesh


def write_stl(mesh: BladeMesh, path: str | os.PathLike[str]) -> None:
    """Write a blade as binary STL, or nothing at all.

    Parameters
    ----------
    mesh : BladeMesh
    path : path
        Replaced when it exists; written beside first, read back, and then renamed.

    Raises
    ------
    ExportError
        If the file cannot be written, or is not watertight once read back.

    Notes
    -----
    STL has single precision: at 300 mm from the origin a vertex moves by up to 15 nm. Vertices that
    are one stay one, for they are rounded alike.
    """
    path = Path(path)
    beside = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        beside.write_bytes(_mesh(mesh).export(file_type="stl"))
        confirm_stl(beside, triangles=len(mesh.triangles))
        beside.replace(path)
    except OSError as error:
        raise ExportError(f"{path} cannot be written: {error.strerror}") from error
    finally:
        with suppress(OSError):
            beside.unlink()


def confirm_stl(path: str | os.PathLike[str], *, triangles: int) -> None:
    """Read an STL file back and raise ExportError unless it is closed and has all triangles."""
    import trimesh

    again: Any = trimesh.load_mesh(path, file_type="stl")
    if not again.is_watertight or not again.is_winding_consistent or len(again.faces) != triangles:
        raise ExportError(
            f"the STL read back has {len(again.faces)} of {triangles} triangles and "
            f"{'no holes' if again.is_watertight else 'holes'}; ask for a larger --chord-error"
        )


def _mesh(mesh: BladeMesh) -> Any:
    import trimesh

    return trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
