"""What was found on one section."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, final

import numpy as np

from bladecad.arrays import Mask, Points, Vector, seal
from bladecad.deviation.sectioning.gaps import seal_gaps
from bladecad.deviation.sectioning.parameters import Number

if TYPE_CHECKING:
    from bladecad.deviation.sectioning.section_fit import SectionFit


@final
@dataclass(frozen=True, eq=False)
class SectionResult:
    """A section of the nominal, how far the metal is from it, and its numbers.

    name, u     : of the station
    outline     : (n, 3) float, mm; the nominal section as a loop, from the leading edge along the
                  suction side to the trailing edge and back along the other, no point repeated
    normal      : (n, 3) float, unit normals there, out of the metal
    flat        : (n, 2) float, mm; the outline laid flat: from the leading edge along the chord,
                  and across it, suction side up
    flat_normal : (n, 2) float, unit normals in the flat
    suction     : (n,) bool, side of each point
    t           : (n,) float, chordwise place of each point
    deviation   : (n,) float, mm along `normal`, positive outside the metal; NaN where not measured
    uncertainty : (n,) float, mm, half width of its 95 % interval; NaN where not measured
    numbers     : nominal and actual numbers of the section
    fits        : the two-dimensional fits of the section
    points      : how many measured points speak for it
    """

    name: str
    u: float
    outline: Points
    normal: Points
    flat: Points
    flat_normal: Points
    suction: Mask
    t: Vector
    deviation: Vector
    uncertainty: Vector
    numbers: tuple[Number, ...]
    fits: tuple[SectionFit, ...]
    points: int

    def __post_init__(self) -> None:
        n = len(self.t)
        seal(self, outline=(n, 3), normal=(n, 3), flat=(n, 2), flat_normal=(n, 2), t=(n,))
        seal_gaps(self, deviation=(n,), uncertainty=(n,))

    @property
    def measured(self) -> Mask:
        """Where on the outline there is a deviation, (n,) bool."""
        return np.isfinite(self.deviation)

    def number(self, name: str) -> Number:
        """The number of that name."""
        return next(number for number in self.numbers if number.name == name)
