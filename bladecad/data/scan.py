"""A scan: points of a whole blade, in no order, with or without triangles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Points, seal
from bladecad.data.sections import Source


@final
@dataclass(frozen=True, eq=False)
class Scan:
    """Measured points, in the frame of the machine that measured them.

    points    : (k, 3) float, mm
    triangles : (m, 3) int, numbers of points, or None for a cloud
    source    : file, format, unit; its notes say what was dropped
    """

    points: Points
    triangles: NDArray[np.int64] | None
    source: Source

    def __post_init__(self) -> None:
        seal(self, points=(None, 3))
