"""On how many sheets points lie, place by place: two where both sides of a blade are, else one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from bladecad.arrays import Array, Mask, Vector, seal

A_CELL: Final = 300  # points, where there are enough
FEW: Final = 60  # points of a cell that is judged
FEWEST: Final = 3  # rows and columns
ONE: Final = 0.555  # bimodality of what is spread evenly; two sheets have more, noise 1/3
THIN: Final = 0.05  # of the usual scatter: one sheet, whatever its bimodality
STRAY: Final = 0.01  # of the points of a cell, at either end, that are not looked at


@final
@dataclass(frozen=True, eq=False)
class Sheets:
    """The points of each cell of a grid, after a parabola through them.

    modes   : (a, b) float, Sarle's bimodality of what the parabola leaves, (skewness^2 + 1) /
              kurtosis: 1 for any two values, however often each occurs; 0 where points are few
    scatter : (a, b) float, its rms
    """

    modes: Array
    scatter: Array

    def __post_init__(self) -> None:
        shape = np.shape(self.modes)
        seal(self, modes=shape, scatter=shape)

    @property
    def judged(self) -> Mask:
        """Cells with enough points, (a, b)."""
        return np.asarray(self.modes > 0.0)

    @property
    def one(self) -> Mask:
        """Cells whose points lie on one sheet, (a, b)."""
        judged = self.judged
        usual = float(np.quantile(self.scatter[judged], 0.75)) if judged.any() else 0.0
        return judged & ((self.modes < ONE) | (self.scatter < THIN * usual))


def sheets(x: Vector, y: Vector, z: Vector, shape: tuple[int, int]) -> Sheets:
    """Look at points z(x, y) in cells of a grid, fewer than asked for where points are.

    Parameters
    ----------
    x, y, z : (k,) float
        x and y within 0 .. 1; x along the rows of the grid.
    """
    thinner = min(1.0, float(np.sqrt(len(x) / A_CELL / np.prod(shape))))
    rows, columns = (max(int(n * thinner), min(n, FEWEST)) for n in shape)
    cell = np.minimum((x * rows).astype(np.int64), rows - 1) * columns
    cell += np.minimum((y * columns).astype(np.int64), columns - 1)
    order = np.argsort(cell, kind="stable")
    ends = np.cumsum(np.bincount(cell, minlength=rows * columns))
    found = [
        _told(*(v[order[first:end]] for v in (x, y, z)))
        for first, end in zip(np.append(0, ends[:-1]), ends, strict=True)
    ]
    modes, scatter = np.array(found).T.reshape(2, rows, columns)
    return Sheets(modes, scatter)


def _told(x: Vector, y: Vector, z: Vector) -> tuple[float, float]:
    """Bimodality and rms of z over a parabola."""
    if len(z) < FEW:
        return 0.0, 0.0
    x, y = (v - v.mean() for v in (x, y))
    A = np.stack([np.ones_like(x), x, y, x * x, x * y, y * y], axis=1)
    off = np.sort(z - A @ np.linalg.lstsq(A, z)[0])
    off = off[int(STRAY * len(off)) : len(off) - int(STRAY * len(off))]
    off = off - off.mean()
    square = max(float(np.mean(off**2)), 1e-300)
    skewness, kurtosis = np.mean(off**3) / square**1.5, np.mean(off**4) / square**2
    return float((skewness**2 + 1.0) / max(kurtosis, 1.0)), float(np.sqrt(square))
