"""Curves of the kernel from ours, and a surface through points whose shape is free."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from OCP.Geom import Geom_BSplineCurve
from OCP.GeomAbs import GeomAbs_Shape
from OCP.GeomAPI import GeomAPI_PointsToBSplineSurface
from OCP.gp import gp_Pnt
from OCP.TColgp import TColgp_Array1OfPnt, TColgp_Array2OfPnt
from OCP.TColStd import TColStd_Array1OfInteger, TColStd_Array1OfReal

from bladecad.arrays import Array
from bladecad.brep.passage_shape import Line

SURFACE: Final = 1e-2  # mm


def curve_of(line: Line) -> Geom_BSplineCurve:
    """The kernel's own curve."""
    poles = TColgp_Array1OfPnt(1, len(line.poles))
    for i, pole in enumerate(line.poles, start=1):
        poles.SetValue(i, kernel_point(pole))
    values, counts = np.unique(line.knots, return_counts=True)
    knots = TColStd_Array1OfReal(1, len(values))
    times = TColStd_Array1OfInteger(1, len(values))
    for i, (value, count) in enumerate(zip(values.tolist(), counts.tolist(), strict=True), start=1):
        knots.SetValue(i, value)
        times.SetValue(i, count)
    return Geom_BSplineCurve(poles, knots, times, line.degree)


def surface_through(grid: Array) -> Any:
    """A cubic C2 spline surface that follows a grid of points (m, n, 3) to 10 um."""
    m, n, _ = grid.shape
    array = TColgp_Array2OfPnt(1, m, 1, n)
    for i in range(m):
        for j in range(n):
            array.SetValue(i + 1, j + 1, kernel_point(grid[i, j]))
    fit = GeomAPI_PointsToBSplineSurface(array, 3, 3, GeomAbs_Shape.GeomAbs_C2, SURFACE)
    return fit.Surface()


def kernel_point(point: Array) -> gp_Pnt:
    """The kernel's own point."""
    return gp_Pnt(*point.tolist())
