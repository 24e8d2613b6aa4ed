"""Is what stands in the file the solid that was meant?"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import cadquery as cq
import numpy as np

from bladecad.brep.faces import sample_surface
from bladecad.brep.kernel import kernel
from bladecad.brep.reread import CadFile, bounds
from bladecad.brep.solid import Solid
from bladecad.errors import ExportError

GRID = np.linspace(0.0, 1.0, 25)


@final
@dataclass(frozen=True)
class Agreement:
    """How far the file is from the solid.

    volume_error : relative
    drift        : largest distance between the spline faces at equal parameters, and between
                   the centres of the planes, mm
    shift        : largest distance between the corners of the boxes around both, mm
    """

    volume_error: float
    drift: float
    shift: float


def confirm(
    solid: Solid, again: CadFile, *, volume: float = 1e-6, distance: float = 1e-6
) -> Agreement:
    """Compare a solid with the file it was written to.

    Parameters
    ----------
    solid, again : Solid, CadFile
    volume : float
        Largest relative difference of the volumes.
    distance : float
        Largest drift and shift, mm; a file has twelve digits.

    Raises
    ------
    ExportError
        Unless the file holds one valid solid with the same face names, no face more, and
        volume, faces and box within the bounds. The message has the numbers.
    """
    _same_names(solid, again)
    found = _compare(solid, again)
    if found.volume_error > volume or max(found.drift, found.shift) > distance:
        raise ExportError(
            f"{again.format} read back is another blade: volume {found.volume_error:.3g} off "
            f"(relative, {volume:g} allowed), faces {found.drift:.3g} mm, "
            f"box {found.shift:.3g} mm off ({distance:g} mm allowed)"
        )
    return found


def _same_names(solid: Solid, again: CadFile) -> None:
    total = len(again.shape.Faces())
    against = [
        "" if again.solids == 1 else f"{again.solids} solids, not 1",
        "" if again.valid else "the kernel's check fails",
        "" if total == len(solid.faces) else f"{total} faces, not {len(solid.faces)}",
        "" if set(again.faces) == set(solid.faces) else f"faces named {sorted(again.faces)}",
    ]
    if any(against):
        found = "; ".join(filter(None, against))
        raise ExportError(f"{again.format} read back is another blade: {found}")


def _compare(solid: Solid, again: CadFile) -> Agreement:
    with kernel("comparing the file with the solid"):
        return Agreement(
            volume_error=abs(again.volume / solid.witnesses.volume - 1),
            drift=max(_drift(face, again.faces[name]) for name, face in solid.faces.items()),
            shift=float(np.abs(again.bounds - bounds(solid.shape)).max()),
        )


def _drift(face: cq.Face, other: cq.Face) -> float:
    if face.geomType() != other.geomType():
        return float("inf")
    if face.geomType() == "PLANE":
        return float((face.Center() - other.Center()).Length)
    here, there = (sample_surface(one, GRID, GRID) for one in (face, other))
    return float(np.linalg.norm(here - there, axis=-1).max())
