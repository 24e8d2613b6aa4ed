"""Two patches become a solid that is believed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Final, final

import cadquery as cq

from bladecad.arrays import Array, Vector
from bladecad.brep.caps import cap, edge_strip, flatten_ends
from bladecad.brep.faces import plane_face, sample_surface, spline_face
from bladecad.brep.kernel import kernel
from bladecad.brep.limits import Limits
from bladecad.brep.names import (
    AIRFOIL,
    HUB,
    LEADING_EDGE,
    PRESSURE_SIDE,
    SUCTION_SIDE,
    TIP,
    TRAILING_EDGE,
    FaceName,
    expected_counts,
)
from bladecad.brep.outline import check_fold, check_sides, is_round
from bladecad.brep.sew import sew
from bladecad.brep.witnesses import Witnesses, believe, hear_witnesses
from bladecad.errors import GeometryError
from bladecad.surface.patch import SplinePatch
from bladecad.surface.zones import Division, Faces, Part, Zone, divide

NAMES: Final[Mapping[Part, FaceName]] = {
    "suction": SUCTION_SIDE,
    "pressure": PRESSURE_SIDE,
    "leading": LEADING_EDGE,
    "trailing": TRAILING_EDGE,
    "round": AIRFOIL,
}
USUAL: Final = Limits()


@final
@dataclass(frozen=True, eq=False)
class Solid:
    """A watertight blade in mm, with the reasons to believe it.

    shape     : the cadquery solid, normals outward
    faces     : its faces by name: SUCTION_SIDE, PRESSURE_SIDE, HUB, TIP, and LEADING_EDGE or
                TRAILING_EDGE where that edge is blunt or was asked for; or AIRFOIL, HUB, TIP
    witnesses : what the kernel and the quadrature said
    zones     : which part of the sides each face covers; blunt edges and ends are none of them
    """

    shape: cq.Solid
    faces: Mapping[str, cq.Face]
    witnesses: Witnesses
    zones: Mapping[str, Zone] = field(default_factory=dict)


def build_solid(
    suction: SplinePatch,
    pressure: SplinePatch,
    *,
    volume: float,
    limits: Limits = USUAL,
    faces: Faces = 2,
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
    faces : {2, 4, 1}
        The sides as two faces; with a face of its own round each round edge; or one closed face
        all the way round. Blunt edges keep their face. See `surface.zones.divide`.

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
    suction, pressure, plane = flatten_ends(suction, pressure, limits.planar)
    division = divide(suction, pressure, faces, allowed=limits.smooth)
    with kernel("closing the solid"):
        around = _around(division)
        made = {name: spline_face(patch) for name, patch in around.items()}
        made |= {end: _cap_face(division, around, end, plane, limits) for end in (HUB, TIP)}
        shape, named = sew(made, limits.gap)
        witnesses = hear_witnesses(shape, expected=_counts(division, plane), quadrature=volume)
    believe(witnesses, limits)
    zones: dict[str, Zone] = {NAMES[zone.part]: zone for zone in division.zones}
    return Solid(shape, named, witnesses, MappingProxyType(zones))


def sample_face(solid: Solid, name: FaceName, u: Vector, t: Vector) -> Array:
    """Evaluate the kernel's own surface of one face on the grid u x t, (len(u), len(t), 3) mm.

    u, t are the parameters of the patch the face was made of; of a ruled cap u runs from suction,
    0, to pressure, 1, of a blunt edge t does. A plane cap has no such parameters: GeometryError.
    """
    if name not in solid.faces:
        raise GeometryError(f"the solid has no face {name}, only {', '.join(solid.faces)}")
    with kernel(f"sampling {name}"):
        return sample_surface(solid.faces[name], u, t)


def _around(division: Division) -> dict[FaceName, SplinePatch]:
    """The patches around the blade, the faces of blunt edges among them."""
    suction, pressure = division.suction, division.pressure
    around = {NAMES[zone.part]: zone.patch for zone in division.zones}
    if not is_round(suction, pressure, 0):
        around[LEADING_EDGE] = edge_strip(suction, pressure, 0)
    if not is_round(suction, pressure, -1):
        around[TRAILING_EDGE] = edge_strip(suction, pressure, -1)
    return around


def _cap_face(
    division: Division,
    around: Mapping[FaceName, SplinePatch],
    end: FaceName,
    plane: tuple[bool, bool],
    limits: Limits,
) -> cq.Face:
    row = 0 if end == HUB else -1
    if plane[row]:
        return plane_face(_outline(division, around), row)
    section = cap(division.suction, division.pressure, row)
    check_fold(section, end, limits)
    return spline_face(section)


def _outline(division: Division, around: Mapping[FaceName, SplinePatch]) -> list[SplinePatch]:
    """The patches whose rows bound a plane end.

    One line all the way round is divided at the edge: left to itself, the kernel takes as few
    Gauss points for it as for a short one, and its default volume was a third too large.
    """
    if AIRFOIL not in around:
        return list(around.values())
    strips = [patch for name, patch in around.items() if name != AIRFOIL]
    return [division.suction, division.pressure, *strips]


def _counts(division: Division, plane: tuple[bool, bool]) -> tuple[int, int, int]:
    """Vertices, edges and faces; on a ruled end a face round an edge has a vertex there."""
    around = len(_around(division))
    turns = sum(len(zone.stretches) - 1 for zone in division.zones)
    alone = len(division.zones) == 1
    hub, tip = (around if flat and not alone else around + turns for flat in plane)
    return expected_counts(around, hub, tip)
