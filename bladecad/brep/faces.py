"""Arrays become kernel faces; a face becomes points again."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import cadquery as cq
import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakeWire,
)
from OCP.Geom import Geom_BSplineCurve, Geom_BSplineSurface
from OCP.gp import gp_Dir, gp_Pln, gp_Pnt
from OCP.TColgp import TColgp_Array1OfPnt, TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal
from OCP.TopTools import TopTools_ListOfShape

from bladecad.arrays import Array, Points, Vector
from bladecad.brep.caps import best_plane
from bladecad.errors import GeometryError
from bladecad.surface.patch import SplinePatch

DEGENERATE = 1e-7  # mm; a ruled cap ends in a point at a round edge, shorter than this is one


def spline_face(patch: SplinePatch) -> cq.Face:
    """Return the whole patch as a face; kernel U is our u, kernel V our t."""
    return _made(BRepBuilderAPI_MakeFace(_surface(patch), DEGENERATE), "a spline patch")


def plane_face(around: Sequence[SplinePatch], row: int) -> cq.Face:
    """Return the plane bounded by one row, 0 (hub) or -1 (tip), of the patches around a blade.

    Notes
    -----
    On an outline out of plane the kernel gives a null face without a word; the caller has
    flattened the outline, and a null face is refused here.
    """
    middle, normal, _ = best_plane(np.concatenate([patch.poles[row] for patch in around]))
    plane = gp_Pln(_point(middle), gp_Dir(*normal.tolist()))
    return _made(BRepBuilderAPI_MakeFace(plane, _outline(around, row)), "a plane cap")


def sample_surface(face: cq.Face, u: Vector, t: Vector) -> Array:
    """Evaluate the kernel's own surface under a spline face on the grid u x t, (k, l, 3) mm."""
    surface = BRep_Tool.Surface_s(face.wrapped)
    if not isinstance(surface, Geom_BSplineSurface):
        raise GeometryError(f"a {face.geomType().lower()} face has no parameters u and t")
    point, parameters = gp_Pnt(), t.tolist()
    grid = np.empty((len(u), len(t), 3))
    for i, row in enumerate(u.tolist()):
        line = surface.UIso(row)
        for j, place in enumerate(parameters):
            line.D0(place, point)
            grid[i, j] = point.X(), point.Y(), point.Z()
    return grid


def _made(maker: Any, what: str) -> cq.Face:
    if not maker.IsDone() or maker.Face().IsNull():
        raise GeometryError(f"the CAD kernel made no face of {what}: {maker.Error().name}")
    return cq.Face(maker.Face())


def _outline(around: Sequence[SplinePatch], row: int) -> Any:
    edges = TopTools_ListOfShape()
    for patch in around:
        edges.Append(_line(patch.poles[row], patch.knots_t, patch.degree_t))
    wire = BRepBuilderAPI_MakeWire()
    wire.Add(edges)
    if not wire.IsDone() or not wire.Wire().Closed():
        raise GeometryError("the outline of an end section does not close")
    return wire.Wire()


def _line(poles: Points, knots: Vector, degree: int) -> Any:
    array = TColgp_Array1OfPnt(1, len(poles))
    for i, pole in enumerate(poles, start=1):
        array.SetValue(i, _point(pole))
    return BRepBuilderAPI_MakeEdge(Geom_BSplineCurve(array, *_knots(knots), degree)).Edge()


def _surface(patch: SplinePatch) -> Any:
    nu, nt, _ = patch.poles.shape
    array = TColgp_Array2OfPnt(1, nu, 1, nt)
    for i in range(nu):
        for j in range(nt):
            array.SetValue(i + 1, j + 1, _point(patch.poles[i, j]))
    (u, times_u), (t, times_t) = _knots(patch.knots_u), _knots(patch.knots_t)
    return Geom_BSplineSurface(array, u, t, times_u, times_t, patch.degree_u, patch.degree_t)


def _knots(knots: Vector) -> tuple[Any, Any]:
    values, counts = np.unique(knots, return_counts=True)
    places = TColStd_Array1OfReal(1, len(values))
    times = TColStd_Array1OfInteger(1, len(values))
    for i, (value, count) in enumerate(zip(values.tolist(), counts.tolist(), strict=True), start=1):
        places.SetValue(i, value)
        times.SetValue(i, count)
    return places, times


def _point(point: Points) -> Any:
    return gp_Pnt(*point.tolist())
