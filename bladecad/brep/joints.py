"""How smoothly the faces of a blade meet: gap, angle and jump of curvature along every joint."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, Protocol, final

import cadquery as cq
import numpy as np
from OCP.BRep import BRep_Tool
from OCP.Geom import Geom_BSplineSurface
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp
from OCP.TopoDS import TopoDS
from OCP.TopTools import TopTools_IndexedDataMapOfShapeListOfShape

from bladecad.arrays import Array
from bladecad.brep.kernel import kernel
from bladecad.brep.names import HUB, TIP
from bladecad.brep.seen import look_at, normal_curvature, places_of
from bladecad.surface.zones import Zone

PLACES: Final = 401  # along an edge
BOTH: Final = (0.5 - 1e-12, 0.5 + 1e-12)  # sides of an edge line in the middle of a face
NONE: Final[Mapping[str, Zone]] = MappingProxyType({})
CORNER: Final = 1.0  # degrees; at more the faces are not meant to meet smoothly


class Body(Protocol):
    """A solid or a file: a shape whose faces have names."""

    @property
    def shape(self) -> cq.Shape:
        """The kernel's shape."""
        ...

    @property
    def faces(self) -> Mapping[str, cq.Face]:
        """Its faces by name."""
        ...


@final
@dataclass(frozen=True)
class Joint:
    """A line along which two faces of a blade meet, or one face runs round an edge.

    faces  : their names, twice the same where it is one
    edge   : "leading", "trailing", or "seam" where a closed face begins and ends
    length : mm
    gap    : largest distance between the two faces at equal places of the edge, mm
    angle  : largest angle between their normals, G1, degrees
    jump   : largest difference of their normal curvatures across the edge, G2, 1/mm
    curvature : the largest of those curvatures, 1/mm, to compare with
    """

    faces: tuple[str, str]
    edge: str
    length: float
    gap: float
    angle: float
    jump: float
    curvature: float

    @property
    def smooth(self) -> bool:
        """Whether the faces are meant to meet smoothly; at more than a degree it is a corner."""
        return self.angle <= CORNER


def joints(body: Body, zones: Mapping[str, Zone] = NONE) -> tuple[Joint, ...]:
    """Measure every line along the span where two faces of the sides meet, or one runs round.

    Parameters
    ----------
    body : Solid or CadFile
        Edges of HUB and TIP, and of the faces of blunt edges, are corners by design and left out.
    zones : mapping
        Of the solid: the edge lines inside its faces are measured too, from both sides.

    Notes
    -----
    Across an edge where the normals agree, two faces have the same curvature in every direction
    as soon as they have in one that is not along the edge (Pegna and Wolter, Geometrical criteria
    to guarantee curvature continuity of blend surfaces, 1992): one number tells G2.
    """
    with kernel("measuring the joints"):
        names = {name: face for name, face in body.faces.items() if _is_side(name, face)}
        between = TopTools_IndexedDataMapOfShapeListOfShape()
        kinds = TopAbs_ShapeEnum.TopAbs_EDGE, TopAbs_ShapeEnum.TopAbs_FACE
        TopExp.MapShapesAndAncestors_s(body.shape.wrapped, *kinds, between)
        found = []
        for edge in body.shape.Edges():
            beside = [cq.Face(face) for face in between.FindFromKey(edge.wrapped)]
            met = [name for face in beside for name in names if names[name].isSame(face)]
            if len(met) == 2:
                found.append(_measured(edge, (met[0], met[1]), names))
        found += [_inside(name, zone, names[name]) for name, zone in zones.items()
                  if len(zone.stretches) > 1]  # fmt: skip
        return tuple(sorted(found, key=lambda joint: (joint.edge, joint.faces)))


def _is_side(name: str, face: cq.Face) -> bool:
    """Ends are none, nor are the ruled faces of blunt edges."""
    surface = BRep_Tool.Surface_s(face.wrapped)
    return (
        name not in (HUB, TIP)
        and isinstance(surface, Geom_BSplineSurface)
        and surface.VDegree() > 1
    )


def _measured(edge: cq.Edge, met: tuple[str, str], names: Mapping[str, cq.Face]) -> Joint:
    first, last = BRep_Tool.Range_s(edge.wrapped)
    places = np.linspace(first, last, PLACES)
    other = TopoDS.Edge_s(edge.wrapped.Reversed()) if met[0] == met[1] else edge.wrapped
    sides = [
        look_at(names[name], places_of(wrapped, names[name], places))
        for wrapped, name in zip((edge.wrapped, other), met, strict=True)
    ]
    return _compared(met, _which(met, float(sides[0]["t"].mean())), sides)


def _inside(name: str, zone: Zone, face: cq.Face) -> Joint:
    """The edge line a face runs round, at t = 1/2, seen from just before and just behind it."""
    u = np.linspace(0.0, 1.0, PLACES)
    sides = [look_at(face, np.stack([u, np.full(PLACES, t)], axis=1)) for t in BOTH]
    edge = "leading" if zone.stretches[0].last < 0.5 else "trailing"
    return _compared((name, name), edge, sides)


def _compared(met: tuple[str, str], edge: str, sides: Sequence[Mapping[str, Array]]) -> Joint:
    X, n = (np.stack([side[key] for side in sides]) for key in ("X", "n"))
    tau = np.gradient(X[0], axis=0)
    across = np.cross(n[0], tau / np.linalg.norm(tau, axis=1, keepdims=True))
    k = np.stack([normal_curvature(side, across) for side in sides])
    angle = np.arctan2(np.linalg.norm(np.cross(*n), axis=1), np.einsum("ix,ix->i", *n))
    return Joint(
        met,
        edge,
        float(np.linalg.norm(np.diff(X[0], axis=0), axis=1).sum()),
        float(np.linalg.norm(X[1] - X[0], axis=1).max()),
        float(np.degrees(angle.max())),
        float(np.abs(k[1] - k[0]).max()),
        float(np.abs(k).max()),
    )


def _which(met: tuple[str, str], t: float) -> str:
    if met[0] == met[1]:
        return "seam"
    for edge in ("leading", "trailing"):
        if f"{edge.upper()}_EDGE" in met:
            return edge
    return "leading" if t < 0.5 else "trailing"
