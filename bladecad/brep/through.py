"""Splines of the kernel through points, where their exact shape is not ours to keep."""

from __future__ import annotations

from typing import Any, Final

from OCP.GeomAbs import GeomAbs_Shape
from OCP.GeomAPI import GeomAPI_PointsToBSpline, GeomAPI_PointsToBSplineSurface
from OCP.gp import gp_Pnt
from OCP.TColgp import TColgp_Array1OfPnt, TColgp_Array2OfPnt

from bladecad.arrays import Array, Points

CURVE: Final = 1e-4  # mm
SURFACE: Final = 1e-2  # mm


def curve_through(points: Points) -> Any:
    """A cubic C2 spline that follows points to a tenth of a micron."""
    array = TColgp_Array1OfPnt(1, len(points))
    for i, point in enumerate(points, start=1):
        array.SetValue(i, kernel_point(point))
    return GeomAPI_PointsToBSpline(array, 3, 3, GeomAbs_Shape.GeomAbs_C2, CURVE).Curve()


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
