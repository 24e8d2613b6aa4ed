"""The passage as STEP: written, read back, compared."""

from __future__ import annotations

import os

from bladecad.brep.passage_shape import PassageShape
from bladecad.brep.passage_solid import PassageSolid, passage_solid
from bladecad.brep.reread import read_step
from bladecad.errors import ExportError
from bladecad.export.cad.step import write_step

VOLUME = 1e-6  # relative, of the file against its solid


def write_passage_step(
    shape: PassageShape, path: str | os.PathLike[str], *, name: str
) -> PassageSolid:
    """Write a passage as one STEP solid with named faces, and confirm what stands in the file.

    Raises
    ------
    GeometryError
        If the kernel does not make the solid.
    ExportError
        If the file cannot be written, or read back is another body.
    """
    solid = passage_solid(shape)
    write_step(solid, path, name=name)
    again = read_step(path)
    against = [
        "" if again.solids == 1 else f"{again.solids} solids, not 1",
        "" if again.valid else "the kernel's check fails",
        "" if set(again.faces) == set(solid.faces) else f"faces named {sorted(again.faces)}",
    ]
    error = abs(again.volume / solid.volume - 1.0)
    against += [f"volume {error:.2g} (relative) off, {VOLUME:g} allowed"] if error > VOLUME else []
    if any(against):
        raise ExportError("STEP read back is another passage: " + "; ".join(filter(None, against)))
    return solid
