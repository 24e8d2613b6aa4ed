"""Two patches become a solid that is believed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, final

import cadquery as cq

from bladecad.arrays import Array, Vector
from bladecad.brep.caps import cap, edge_strip, flatten_ends
from bladecad.brep.faces import plane_face, sample_surface, spline_face
from bladecad.brep.kernel import kernel
from bladecad.brep.limits import Limits
from bladecad.brep.names import (
    HUB,
    LEADING_EDGE,
    PRESSURE_SIDE,
    SUCTION_SIDE,
    TIP,
    TRAILING_EDGE,
    FaceName,
)
from bladecad.brep.outline import check_fold, check_sides, is_round
from bladecad.brep.sew import sew
from bladecad.brep.witnesses import Witnesses, believe, hear_witnesses
from bladecad.errors import GeometryError
from bladecad.surface.patch import SplinePatch

USUAL: Final = Limits()


@final
@dataclass(frozen=True, eq=False)
class Solid:
    """A watertight blade in mm, with the reasons to believe it.

    shape     : the cadquery solid, normals outward
    faces     : its faces by name: SUCTION_SIDE, PRESSURE_SIDE, HUB, TIP, and LEADING_EDGE or
                TRAILING_EDGE where that edge is blunt
    witnesses : what the kernel and the quadrature said
    """

    shape: cq.Solid
    faces: Mapping[str, cq.Face]
    witnesses: Witnesses


def build_solid(
    suction: SplinePatch, pressure: SplinePatch, *, volume: float, limits: Limits = USUAL
) -> Solid:
    """Close the two sides of a blade to a solid, and believe it only on its witnesses.

    Parameters
    ----------
    suction, pressure : SplinePatch
        On the same knots. A pole column, first or last, that both share bit by bit is a round
        edge; columns apart are a blunt edge and get a ruled face between them.
    volume : float
        mm^3, from a quadrature over the patches and ruled ends that never met the kernel.
    limits : Limits
        What the solid is held to.

    Raises
    ------
    GeometryError
        If the sides do not bound a blade, if the kernel fails, or if a witness speaks against
        the solid; the message has the numbers.

    Notes
    -----
    Ends planar to `limits.planar` are dropped onto their plane and capped by it. Other ends are
    ruled between suction and pressure line at equal t, of degree (1, 3): exact on the outline,
    where the kernel's filling would be off by microns.
    """
    if not (math.isfinite(volume) and volume > 0):
        raise GeometryError(f"the quadrature volume is {volume} mm^3; the sides bound nothing")
    check_sides(suction, pressure, limits)
    with kernel("closing the solid"):
        faces = _faces(suction, pressure, limits)
        shape, named = sew(faces, limits.gap)
        witnesses = hear_witnesses(shape, faces=len(faces), quadrature=volume)
    believe(witnesses, limits)
    return Solid(shape, named, witnesses)


def sample_face(solid: Solid, name: FaceName, u: Vector, t: Vector) -> Array:
    """Evaluate the kernel's own surface of one face on the grid u x t, (len(u), len(t), 3) mm.

    u, t are the parameters of the patch the face was made of; of a ruled cap u runs from suction,
    0, to pressure, 1, of a blunt edge t does. A plane cap has no such parameters: GeometryError.
    """
    if name not in solid.faces:
        raise GeometryError(f"the solid has no face {name}, only {', '.join(solid.faces)}")
    with kernel(f"sampling {name}"):
        return sample_surface(solid.faces[name], u, t)


def _faces(suction: SplinePatch, pressure: SplinePatch, limits: Limits) -> dict[FaceName, cq.Face]:
    suction, pressure, plane = flatten_ends(suction, pressure, limits.planar)
    faces: dict[FaceName, cq.Face] = {
        SUCTION_SIDE: spline_face(suction),
        PRESSURE_SIDE: spline_face(pressure),
        HUB: _cap_face(cap(suction, pressure, 0), HUB, plane[0], limits),
        TIP: _cap_face(cap(suction, pressure, -1), TIP, plane[1], limits),
    }
    if not is_round(suction, pressure, 0):
        faces[LEADING_EDGE] = spline_face(edge_strip(suction, pressure, 0))
    if not is_round(suction, pressure, -1):
        faces[TRAILING_EDGE] = spline_face(edge_strip(suction, pressure, -1))
    return faces


def _cap_face(section: SplinePatch, end: str, plane: bool, limits: Limits) -> cq.Face:
    if plane:
        return plane_face(section)
    check_fold(section, end, limits)
    return spline_face(section)
