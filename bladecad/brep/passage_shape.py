"""What the solid of a passage is built from, as arrays; free of the kernel."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from bladecad.arrays import Array, Points, seal
from bladecad.surface.patch import SplinePatch


@final
@dataclass(frozen=True, eq=False)
class PassageShape:
    """A passage as arrays, in mm and radians.

    hub, shroud       : (n, 3) points along the walls, inlet to outlet, in the half plane in which
                        the sector starts
    hub_end, tip_end  : the same where the blade ends before a gap, else None
    periodic          : (m, k, 3) points of the first periodic face, well beyond walls and ends
    suction, pressure : both sides of the blade, beyond both walls
    axis              : column of the machine axis
    sweep             : angle of the sector, wide enough for both periodic faces
    pitch             : angle from the first periodic face to the second
    volume            : mm^3 of the fluid, by quadrature
    """

    hub: Points
    shroud: Points
    hub_end: Points | None
    tip_end: Points | None
    periodic: Array
    suction: SplinePatch
    pressure: SplinePatch
    axis: int
    sweep: float
    pitch: float
    volume: float

    def __post_init__(self) -> None:
        seal(self, hub=(None, 3), shroud=(None, 3), periodic=(None, None, 3))
