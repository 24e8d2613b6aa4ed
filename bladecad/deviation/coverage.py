"""Where the scan reaches: the skin of a blade in cells, and what was measured on each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Vector, seal
from bladecad.deviation.gaps import seal_gaps


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
