"""What all points of a place agree on: the deviation that is left when noise is averaged out."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Mask, Vector
from bladecad.deviation.nearest.feet import Feet
from bladecad.surface.blade import SideName

FEWEST: Final = 30  # points that a cell is judged by
ERRORS: Final = 3.0  # standard errors of the mean that noise may explain
LEVELS: Final = ((80, 320), (40, 160), (20, 80), (10, 40), (5, 20))  # cells over u and t
Cells = NDArray[np.int64]


@final
@dataclass(frozen=True)
class Place:
    """The mean deviation of a cell.

    side, u, t : of its middle
    mean       : mm, positive outside the metal
    scatter    : mm, standard deviation of the points about it
    points     : how many it is the mean of
    """

    side: SideName
    u: float
    t: float
    mean: float
    scatter: float
    points: int

    @property
    def error(self) -> float:
        """Standard error of the mean, mm, as far as points err independently."""
        return float(self.scatter / np.sqrt(self.points))

    @property
    def sure(self) -> float:
        """Size of the mean, less three standard errors, mm; 0 where noise may explain it."""
        return max(abs(self.mean) - ERRORS * self.error, 0.0)


@final
@dataclass(frozen=True)
class Systematic:
    """The largest mean deviation over all cells.

    worst : Place, None where no cell has thirty points
    cells : how many were judged, of all sizes
    share : of the points, those that lie in one of them
    """

    worst: Place | None
    cells: int
    share: float

    @property
    def largest(self) -> float:
        """Size of the largest, less three standard errors, mm."""
        return self.worst.sure if self.worst else 0.0


def systematic(feet: Feet, weight: Vector) -> Systematic:
    """Average the deviations over cells of the skin, from fine to coarse, and find the largest.

    Parameters
    ----------
    feet : Feet
        Of k points; those beyond the span are left out.
    weight : (k,) float
        0 for points that were set aside as outliers. Where most points of a cell were, they are
        what was measured there, and count.

    Notes
    -----
    Every cell with thirty points is judged, of each of five sizes, 1/80 to 1/5 of the span high
    and 1/320 to 1/20 of a side long: a place is judged as finely as its points allow.
    """
    feet, kept = feet[~feet.rim], weight[~feet.rim] > 0.0
    judged = np.zeros(len(kept), bool)
    worst: Place | None = None
    cells = 0
    for a, b in LEVELS:
        cell = cells_of(feet, a, b)
        count, mean, scatter = _means(cell, feet.distance, counted(cell, kept), 2 * a * b)
        full = count >= FEWEST
        cells += int(full.sum())
        judged |= full[cell]
        for place in _largest(full, count, mean, scatter, (a, b)):
            worst = place if worst is None or place.sure > worst.sure else worst
    return Systematic(worst, cells, float(judged.mean()) if len(judged) else 0.0)


def cells_of(feet: Feet, a: int, b: int) -> Cells:
    """Number of the cell that holds each foot, of a cells over u and b over t on either side."""
    i = np.minimum((feet.u * a).astype(np.int64), a - 1)
    j = np.minimum((feet.t * b).astype(np.int64), b - 1)
    return np.asarray((np.where(feet.suction, 0, a) + i) * b + j)


def counted(cell: Cells, kept: Mask) -> Mask:
    """The points that count: those kept, and all of a cell that most were not kept of."""
    n = int(cell.max(initial=0)) + 1
    crowd = 2 * np.bincount(cell[kept], minlength=n) < np.bincount(cell, minlength=n)
    return np.asarray(kept | crowd[cell])


def _means(cell: Cells, d: Vector, use: Mask, n: int) -> tuple[Cells, Array, Array]:
    """Points, mean and standard deviation of every cell."""
    cell, d = cell[use], d[use]
    count = np.bincount(cell, minlength=n)
    some = np.maximum(count, 1)
    mean = np.bincount(cell, d, n) / some
    square = np.bincount(cell, (d - mean[cell]) ** 2, n)
    return count, mean, np.sqrt(square / np.maximum(some - 1, 1))


def _largest(
    full: Mask, count: Cells, mean: Array, scatter: Array, shape: tuple[int, int]
) -> Iterator[Place]:
    if not full.any():
        return
    a, b = shape
    sure = np.where(full, np.abs(mean) - ERRORS * scatter / np.sqrt(np.maximum(count, 1)), -np.inf)
    k = int(sure.argmax())
    side, i, j = k // (a * b), k // b % a, k % b
    yield Place(
        "pressure" if side else "suction", (i + 0.5) / a, (j + 0.5) / b,
        float(mean[k]), float(scatter[k]), int(count[k]),
    )  # fmt: skip
