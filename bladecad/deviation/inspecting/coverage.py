"""Where the scan reaches: the skin of a blade in cells, and what was measured on each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Vector, seal
from bladecad.deviation.inspecting.cells import COARSEST, FINEST, Ruler, halved, halvings, ruler
from bladecad.deviation.nearest.feet import Feet
from bladecad.deviation.nearest.nominal import Nominal
from bladecad.deviation.sectioning.gaps import seal_gaps
from bladecad.surface.blade import BladeSurface, SideName
from bladecad.tolerance import Tolerances

SIDES: Final[tuple[SideName, ...]] = ("suction", "pressure")
GAUSS = (0.5 - np.sqrt(1.0 / 12.0), 0.5 + np.sqrt(1.0 / 12.0))  # two places a cell


@final
@dataclass(frozen=True, eq=False)
class Map:
    """The skin cut into cells of u and t; side 0 is the suction side, 1 the pressure side.

    u, t            : (a + 1,) and (b + 1,) float, borders of the cells, rising from 0 to 1
    count           : (2, a, b) int, points on the cell
    mean, lowest, highest : (2, a, b) float, mm, of their deviations; NaN where there is no point
    area            : (2, a, b) float, mm^2; half the face of a cut-off edge is part of the cell
                      beside it
    measured        : (2, a, b) bool; False where the scan does not reach: such a cell is not good,
                      it is unknown
    """

    u: Vector
    t: Vector
    count: NDArray[np.int64]
    mean: Array
    lowest: Array
    highest: Array
    area: Array
    measured: NDArray[np.bool_]

    def __post_init__(self) -> None:
        shape = (2, len(self.u) - 1, len(self.t) - 1)
        seal(self, u=(None,), t=(None,), area=shape)
        seal_gaps(self, mean=shape, lowest=shape, highest=shape)

    @property
    def share(self) -> float:
        """Share of the blade's area that is measured."""
        return float(self.area[self.measured].sum() / self.area.sum())

    def cell(self, feet: Feet) -> NDArray[np.int32]:
        """Number of the cell of every foot, in the order of `count.ravel()`."""
        a, b = len(self.u) - 1, len(self.t) - 1
        i = np.interp(feet.u, self.u, np.arange(a + 1)).astype(np.int32)
        j = np.interp(feet.t, self.t, np.arange(b + 1)).astype(np.int32)
        return _number(feet, np.minimum(i, a - 1), np.minimum(j, b - 1), a, b)


def map_of(nominal: Nominal, feet: Feet, tolerances: Tolerances | None = None) -> Map:
    """Sort the points into cells as fine as they fill, and say where the scan does not reach.

    Parameters
    ----------
    nominal : Nominal
    feet : Feet
        Of the points; those beyond the span are left out.
    tolerances : Tolerances, optional
        The borders of their zones are borders of cells.

    Notes
    -----
    A cell is measured if it has a point, or if two cells that face each other across it have: one
    empty cell between points is chance, two are a hole. Cells are at least a tenth of the span
    high until points reach both halves of most of them, so a section alone speaks for no more.
    """
    margins = (tolerances.hub_margin, tolerances.tip_margin) if tolerances else (0.0, 0.0)
    edges = (tolerances.le_zone, tolerances.te_zone) if tolerances else (0.0, 0.0)
    over, along = ruler(*margins, COARSEST[0]), ruler(*edges, COARSEST[1])
    feet = feet if not feet.rim.any() else feet[~feet.rim]
    finest = _count(feet, halved(over, FINEST[0]), halved(along, FINEST[1]))
    times_u, times_t = halvings(finest, along, _shape(nominal.surface))
    return _filled(nominal.surface, feet, halved(over, times_u), halved(along, times_t))


def _number(
    feet: Feet, i: NDArray[np.int32], j: NDArray[np.int32], a: int, b: int
) -> NDArray[np.int32]:
    return np.where(feet.suction, i, i + np.int32(a)) * np.int32(b) + j


def _count(feet: Feet, over: Ruler, along: Ruler) -> NDArray[np.int64]:
    a, b = int(over.firsts[-1]), int(along.firsts[-1])
    cell = _number(feet, over.cell(feet.u), along.cell(feet.t), a, b)
    return np.bincount(cell, minlength=2 * a * b).reshape(2, a, b)


def _filled(surface: BladeSurface, feet: Feet, over: Ruler, along: Ruler) -> Map:
    a, b = int(over.firsts[-1]), int(along.firsts[-1])
    cell = _number(feet, over.cell(feet.u), along.cell(feet.t), a, b)
    count = np.bincount(cell, minlength=2 * a * b)
    total = np.bincount(cell, feet.distance, 2 * a * b)
    mean = np.divide(total, count, out=np.full(2 * a * b, np.nan), where=count > 0)
    lowest, highest = np.full(2 * a * b, np.inf), np.full(2 * a * b, -np.inf)
    np.minimum.at(lowest, cell, feet.distance)
    np.maximum.at(highest, cell, feet.distance)
    lowest[count == 0] = highest[count == 0] = np.nan
    shape = (2, a, b)
    return Map(
        over.borders,
        along.borders,
        count.reshape(shape),
        mean.reshape(shape),
        lowest.reshape(shape),
        highest.reshape(shape),
        _areas(surface, over.borders, along.borders),
        _closed(surface, count.reshape(shape) > 0),
    )


def _closed(surface: BladeSurface, has: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Cells with points, and those between two of them, also across the edges."""
    le, te = has[::-1, :, :1], has[::-1, :, -1:]
    ring = np.concatenate([le, has, te], axis=2)
    closed = has | (ring[:, :, :-2] & ring[:, :, 2:])
    closed[:, 1:-1] |= has[:, :-2] & has[:, 2:]
    return np.asarray(closed)


def _shape(surface: BladeSurface) -> tuple[float, float]:
    """Height and length of the suction side, mm."""
    x = np.linspace(0.1, 0.9, 5)
    height, length = (
        float(np.linalg.norm(surface("suction", x, x, *order), axis=2).mean())
        for order in ((1, 0), (0, 1))
    )
    return height, length


def _areas(surface: BladeSurface, u: Vector, t: Vector) -> Array:
    """Integral of |S_u x S_t| over each cell, by two Gauss points each way, (2, a, b), mm^2."""
    du, dt = np.diff(u), np.diff(t)
    gu, gt = ((x[:-1, None] + np.diff(x)[:, None] * GAUSS).ravel() for x in (u, t))
    area = np.empty((2, len(du), len(dt)))
    for k, name in enumerate(SIDES):
        n = np.cross(surface(name, gu, gt, 1, 0), surface(name, gu, gt, 0, 1))
        size = np.sqrt(np.einsum("utx,utx->ut", n, n)).reshape(len(du), 2, len(dt), 2)
        area[k] = size.mean(axis=(1, 3)) * du[:, None] * dt
    for end, kind in ((0, surface.le), (-1, surface.te)):
        if kind == "blunt":
            area[:, :, end] += _half_face(surface, u, float(end != 0))
    return area


def _half_face(surface: BladeSurface, u: Vector, at: float) -> Vector:
    """Area of half the ruled face of a cut-off edge between the borders u, (a,), mm^2."""
    middle, end = 0.5 * (u[1:] + u[:-1]), np.array([at])
    S, P = (surface(name, middle, end)[:, 0] for name in SIDES)
    Su, Pu = (surface(name, middle, end, 1, 0)[:, 0] for name in SIDES)
    n = np.cross(P - S, 0.5 * (Su + Pu))
    return np.asarray(0.5 * np.linalg.norm(n, axis=1) * np.diff(u))
