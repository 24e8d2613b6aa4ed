"""Why the solid is believed: the kernel's check, its counts, and a volume from elsewhere."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import cadquery as cq
from OCP.BRep import BRep_Tool
from OCP.BRepGProp import BRepGProp
from OCP.GProp import GProp_GProps
from OCP.TopAbs import TopAbs_ShapeEnum
from OCP.TopExp import TopExp
from OCP.TopTools import TopTools_IndexedDataMapOfShapeListOfShape

from bladecad.brep.limits import Limits
from bladecad.errors import GeometryError

# Relative. The default of GProp is off by 1e-4 to 1e-3 on such faces; asked for 1e-7 it believes
# itself too early and may be off by 2e-6; asked for 1e-9 it was within 2e-8 on every real blade.
VOLUME_PRECISION = 1e-9
AREA_PRECISION = 1e-6


@final
@dataclass(frozen=True)
class Witnesses:
    """What was found, beside what was expected.

    valid           : the kernel's own check
    counts, expected: vertices, edges, faces; edges shrunk to a point (where a ruled cap ends in a
                      round edge) are not counted
    free_edges      : edges that do not lie between exactly two faces
    edge_tolerance  : the largest of all edges, mm
    volume, area    : by the kernel, mm^3 and mm^2
    quadrature      : the volume from outside the kernel, mm^3
    """

    valid: bool
    counts: tuple[int, int, int]
    expected: tuple[int, int, int]
    free_edges: int
    edge_tolerance: float
    volume: float
    area: float
    quadrature: float

    @property
    def euler(self) -> int:
        """V - E + F, 2 for a ball."""
        vertices, edges, faces = self.counts
        return vertices - edges + faces

    @property
    def volume_error(self) -> float:
        """Kernel against quadrature, relative and positive."""
        return abs(self.volume / self.quadrature - 1)


def hear_witnesses(
    solid: cq.Solid, *, expected: tuple[int, int, int], quadrature: float
) -> Witnesses:
    """Ask the kernel about a solid that should have these counts and this volume in mm^3."""
    edges = solid.Edges()
    return Witnesses(
        valid=solid.isValid(),
        counts=(len(solid.Vertices()), len(edges), len(solid.Faces())),
        expected=expected,
        free_edges=_free_edges(solid),
        edge_tolerance=max(BRep_Tool.Tolerance_s(edge.wrapped) for edge in edges),
        volume=volume(solid),
        area=_area(solid),
        quadrature=quadrature,
    )


def believe(witnesses: Witnesses, limits: Limits) -> None:
    """Raise GeometryError with all numbers that speak against the solid, if any do."""
    against = [text for text in _doubts(witnesses, limits) if text]
    if against:
        raise GeometryError("the solid is not believed: " + "; ".join(against))


def volume(solid: cq.Shape) -> float:
    """Return the volume in mm^3 to 1e-9 relative, positive when the normals look outward."""
    properties = GProp_GProps()
    BRepGProp.VolumeProperties_s(solid.wrapped, properties, VOLUME_PRECISION)
    return float(properties.Mass())


def _doubts(w: Witnesses, limits: Limits) -> list[str]:
    return [
        "" if w.valid else "the kernel's check fails",
        "" if w.counts == w.expected else f"V, E, F are {w.counts}, not {w.expected}",
        "" if w.euler == 2 else f"V - E + F = {w.euler}, not 2",
        "" if w.free_edges == 0 else f"{w.free_edges} edges do not join two faces",
        ""
        if w.edge_tolerance <= limits.edge
        else f"edge tolerance {w.edge_tolerance:.3g} mm is above {limits.edge:g} mm",
        ""
        if w.volume_error <= limits.volume
        else f"kernel volume {w.volume:.9g} mm^3 against quadrature {w.quadrature:.9g} mm^3, "
        f"{w.volume_error:.3g} apart, {limits.volume:g} allowed",
    ]


def _area(solid: cq.Solid) -> float:
    properties = GProp_GProps()
    BRepGProp.SurfaceProperties_s(solid.wrapped, properties, AREA_PRECISION)
    return float(properties.Mass())


def _free_edges(solid: cq.Solid) -> int:
    between = TopTools_IndexedDataMapOfShapeListOfShape()
    shapes = TopAbs_ShapeEnum.TopAbs_EDGE, TopAbs_ShapeEnum.TopAbs_FACE
    TopExp.MapShapesAndAncestors_s(solid.wrapped, *shapes, between)
    return sum(between.FindFromKey(edge.wrapped).Size() != 2 for edge in solid.Edges())
