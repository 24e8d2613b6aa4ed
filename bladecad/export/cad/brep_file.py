"""BREP, the kernel's own format, exact to the last digit; it has no names, only an order."""

from __future__ import annotations

import os
from pathlib import Path

from OCP.BRepTools import BRepTools
from OCP.Message import Message_ProgressRange
from OCP.TopTools import TopTools_FormatVersion

from bladecad.brep.kernel import kernel
from bladecad.brep.solid import Solid
from bladecad.errors import ExportError


def write_brep(solid: Solid, path: str | os.PathLike[str]) -> None:
    """Write the blade as BREP, format version 1, which every version of the kernel reads, in mm.

    Raises
    ------
    ExportError
        If the kernel does not write.

    Notes
    -----
    Faces have no names there; they stand in the order of `solid.shape.Faces()`, and reading keeps
    it.
    """
    path = Path(path)
    try:
        with path.open("wb"):
            pass  # says why a file cannot be written, which the kernel does not
    except OSError as error:
        raise ExportError(f"{path} cannot be written: {error.strerror}") from error
    version = TopTools_FormatVersion.TopTools_FormatVersion_VERSION_1
    with kernel(f"writing {path.name}"):
        written = BRepTools.Write_s(
            solid.shape.wrapped, str(path), False, False, version, Message_ProgressRange()
        )
    if not written:
        raise ExportError(f"the CAD kernel does not write {path}")
