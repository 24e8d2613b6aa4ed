"""Where points stand on a blade: foot, distance, normal, and the place in blade coordinates."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Mask, Points, Vector, seal

FACES: Final = ("SUCTION_SIDE", "PRESSURE_SIDE", "LEADING_EDGE", "TRAILING_EDGE", "HUB", "TIP")


@final
@dataclass(frozen=True, eq=False)
class Feet:
    """The nearest place of the blade to every point.

    distance : (k,) float, mm, positive outside the metal
    foot     : (k, 3) float, mm, the nearest place
    normal   : (k, 3) float, unit normal of the blade there, out of the metal
    face     : (k,) int8, number in `FACES` of the face it lies on
    suction  : (k,) bool, whether it is on the suction side, or that half of another face
    u, t     : (k,) float, span and chordwise place of the foot, see `BladeSurface`
    rim      : (k,) bool, the foot lies on the border at hub or tip: the point stands beyond the
               span, its distance is no deviation and its sign is that of the side
    unsettled : points whose search was left before the foot stood still
    """

    distance: Vector
    foot: Points
    normal: Points
    face: NDArray[np.int8]
    suction: Mask
    u: Vector
    t: Vector
    rim: Mask
    unsettled: int = 0

    def __post_init__(self) -> None:
        k = len(self.distance)
        seal(self, distance=(k,), foot=(k, 3), normal=(k, 3), u=(k,), t=(k,))

    def __getitem__(self, which: NDArray[np.intp] | Mask) -> Feet:
        """The feet of some of the points."""
        return Feet(
            self.distance[which], self.foot[which], self.normal[which], self.face[which],
            self.suction[which], self.u[which], self.t[which], self.rim[which],
        )  # fmt: skip
