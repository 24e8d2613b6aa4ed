"""What the solid of a passage is built from, as arrays; free of the kernel."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from bladecad.arrays import Array, Points, Vector, seal
from bladecad.surface.patch import SplinePatch


@final
@dataclass(frozen=True, eq=False)
class Line:
    """A B-spline curve.

    poles  : (n, 3) float, mm
    knots  : (n + degree + 1,) float, ends repeated degree + 1 times
    degree : int
    """

    poles: Points
    knots: Vector
    degree: int

    def __post_init__(self) -> None:
        n = len(self.poles)
        seal(self, poles=(n, 3), knots=(n + self.degree + 1,))


@final
@dataclass(frozen=True, eq=False)
class PassageShape:
    """A passage as arrays, in mm and radians.

    hub, shroud       : the walls, inlet to outlet, in the half plane in which the sector starts
    hub_end, tip_end  : the same where the blade ends before a gap, else None
    periodic          : (m, k, 3) points of the first periodic face, well beyond walls and ends
    suction, pressure : both sides of the blade, beyond both walls
    axis              : column of the machine axis
    sweep             : angle of the sector, wide enough for both periodic faces
    pitch             : angle from the first periodic face to the second
    volume            : mm^3 of the fluid, by quadrature
    wall_error        : mm, how far hub and shroud are from the walls as they are given; printed to
                        tenths they are smoothed, which the kernel needs
    """

    hub: Line
    shroud: Line
    hub_end: Line | None
    tip_end: Line | None
    periodic: Array
    suction: SplinePatch
    pressure: SplinePatch
    axis: int
    sweep: float
    pitch: float
    volume: float
    wall_error: float

    def __post_init__(self) -> None:
        seal(self, periodic=(None, None, 3))
