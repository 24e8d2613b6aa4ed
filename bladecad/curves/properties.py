"""What a blade engineer asks of a section: chord, stagger, thickness, camber, edge radii."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from bladecad.arrays import Vector, seal
from bladecad.curves.camber import camber_line
from bladecad.curves.laid import Laid, lay
from bladecad.curves.nose import nose_radius
from bladecad.curves.sides import BladeLines


@final
@dataclass(frozen=True, eq=False)
class SectionProperties:
    """One section by its numbers, in its own plane or stream surface; mm and radians.

    name, span      : of the section; u is 0 at the hub and 1 at the tip
    chord           : straight distance from the leading to the trailing edge
    stagger         : of the chord against the machine axis (outwards on a radial machine), positive
                      towards growing angles about the axis
    thickness       : diameter of the largest inscribed circle
    thickness_place : of its centre along the chord, 0 at the leading edge, 1 at the trailing edge
    camber          : largest offset of the camber line from the chord, over the chord;
                      positive towards the suction side
    turning         : angle by which the camber line turns from edge to edge
    le_radius, te_radius : of curvature at the nose of a round edge; None if it is not round
    perimeter, area : of the outline, with the faces of cut-off edges
    centroid        : (3,) float, of the area
    """

    name: str
    span: float
    chord: float
    stagger: float
    thickness: float
    thickness_place: float
    camber: float
    turning: float
    le_radius: float | None
    te_radius: float | None
    perimeter: float
    area: float
    centroid: Vector

    def __post_init__(self) -> None:
        seal(self, centroid=(3,))


def properties(lines: BladeLines, axis: int) -> tuple[SectionProperties, ...]:
    """Measure every section on its densified outline.

    Parameters
    ----------
    lines : BladeLines
    axis : {0, 1, 2}
        Column of the machine axis.
    """
    return tuple(_of(lines, k, axis) for k in range(len(lines.names)))


def _of(lines: BladeLines, k: int, axis: int) -> SectionProperties:
    laid = lay(lines, k, axis)
    line = camber_line(laid)
    place, thickness = line.thickest
    le, te = laid.ends
    along, across = te - le
    scale = float(np.interp(place, *_scale_along(laid)))
    pair = lines.suction[k], lines.pressure[k]
    return SectionProperties(
        name=lines.names[k],
        span=float(lines.span[k]),
        chord=laid.chord,
        stagger=float(np.arctan2(-across, along)),
        thickness=thickness * float(np.hypot(along, across)) * scale,
        thickness_place=place,
        camber=line.bow,
        turning=line.turning,
        le_radius=nose_radius(*pair, 0.0) if lines.le == "round" else None,
        te_radius=nose_radius(*pair, 1.0) if lines.te == "round" else None,
        perimeter=laid.perimeter,
        area=laid.area,
        centroid=laid.centroid,
    )


def _scale_along(laid: Laid) -> tuple[Vector, Vector]:
    """Place along the chord and scale there, on the suction side, rising."""
    le, te = laid.ends
    side = slice(0, laid.te[0] + 1)
    x = (laid.flat[side] - le) @ (te - le) / float((te - le) @ (te - le))
    order = np.argsort(x)
    return x[order], laid.scale[side][order]
