"""What can be asked for, where a blade is built from a scan."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal, TypeAlias, final

import numpy as np

from bladecad.arrays import Vector
from bladecad.curves.naming import Hand, Lead
from bladecad.data.sections import Axis, Unit
from bladecad.errors import ToleranceError
from bladecad.fit.blade import Order
from bladecad.scans.finding.height import Height

Direction: TypeAlias = Axis | tuple[float, float, float]
STATIONS: Final = 21
FEWEST, MOST = 4, 201  # stations


@final
@dataclass(frozen=True)
class ScanSettings:
    """What a user can ask for.

    ScanSettings()                    everything found from the scan, the fit to 0.01 mm
    ScanSettings(axis="z", span=(120.0, 150.0))   the airfoil said, not found
    ScanSettings(align=True)          files in the frame of the blade

    tolerance, chord_error : mm; of the surface, and of the triangles
    order       : fixed; else the smallest that explains the scan
    unit        : of the file, where it does not say
    axis        : stacking axis, "x", "y", "z" or a direction
    span        : heights along the axis, mm, between which it is airfoil; radii where it is cut
                  by cylinders
    about       : machine axis through the origin of the scan: cut by cylinders about it
    cone        : half angle of cones about it instead, radians
    le, suction : see `split_sides`
    stations    : how many sections the scan is cut into, to start from
    align       : move everything into the frame of the blade, see `blade_frame`
    allow_partial : build one of several blades, or what a scan with large gaps supports
    """

    tolerance: float = 0.01
    order: Order | None = None
    unit: Unit | None = None
    axis: Direction | None = None
    span: tuple[float, float] | None = None
    about: Direction | None = None
    cone: float = 0.0
    le: Lead | None = None
    suction: Hand | None = None
    chord_error: float = 0.005
    stations: int = STATIONS
    align: bool = False
    allow_partial: bool = False

    def __post_init__(self) -> None:
        for name in ("tolerance", "chord_error"):
            value = getattr(self, name)
            if not 1e-6 <= value <= 10.0:
                raise ToleranceError(
                    f"{name.replace('_', ' ')} = {value} mm; it must lie between 1e-6 and 10 mm"
                )
        if not FEWEST <= self.stations <= MOST:
            raise ToleranceError(f"{self.stations} stations; {FEWEST} to {MOST} are possible")
        if self.span is not None and not self.span[0] < self.span[1]:
            low, high = self.span
            raise ToleranceError(f"span {low:g} to {high:g} mm; the first must be the lower one")

        if self.cone and self.about is None:
            raise ToleranceError(
                f"cones of {np.degrees(self.cone):g} degrees, but about which axis? give --about"
            )

    @property
    def direction(self) -> Vector | None:
        """The stacking axis as asked for, (3,)."""
        return None if self.axis is None else _vector(self.axis)

    @property
    def height(self) -> Height | None:
        """Cylinders or cones as asked for."""
        if self.about is None:
            return None
        a = _vector(self.about)
        kind: Literal["cone", "cylinder"] = "cone" if self.cone else "cylinder"
        return Height(kind, a / np.linalg.norm(a), np.zeros(3), self.cone)


def _vector(direction: Direction) -> Vector:
    if isinstance(direction, str):
        return np.asarray(np.eye(3)["xyz".index(direction)])
    return np.array(direction)
