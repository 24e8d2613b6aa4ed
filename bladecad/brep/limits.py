"""What the solid is held to, each number with its reason."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import final

from bladecad.errors import ToleranceError


@final
@dataclass(frozen=True)
class Limits:
    """Lengths in mm, `volume` relative.

    Limits()                  what every real blade tried so far keeps
    Limits(planar=0)          ruled caps everywhere
    Limits(volume=1e-8)       stricter about the third witness

    planar : an end section this close to a plane is dropped onto it and gets a plane cap; a tenth
        of a micron is far below any tolerance, and a plane is what CAM programs know best
    gap    : edges closer than this are sewn; faces share their pole rows, so it only has to
        cover rounding, and it is the finest that CAD programs agree on
    edge   : the largest tolerance an edge may end with; the kernel starts at 1e-7
    smooth : poles beside a round edge may be moved so far that a face runs through it C2, else it
        stays C1; a tenth of a micron again, most lofts need a picometre
    blunt  : a cut-off edge thinner than this is neither sharp nor a face
    fold   : sides may lie in each other this deep; on a blunted nose they run side by side
    volume : kernel against quadrature; the kernel integrates to 1e-9, Gauss points to rounding, and
        dropping an end onto its plane costs up to 1e-7
    """

    planar: float = 1e-4
    gap: float = 1e-5
    edge: float = 1e-5
    smooth: float = 1e-4
    blunt: float = 1e-3
    fold: float = 2e-3
    volume: float = 1e-6

    def __post_init__(self) -> None:
        for field in fields(self):
            number = getattr(self, field.name)
            if not 0 <= number < 1:
                raise ToleranceError(f"Limits.{field.name} = {number} must lie in 0 .. 1 (mm)")
