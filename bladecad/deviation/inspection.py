"""The whole inspection: a scan against a nominal, and the verdict."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, final

import numpy as np
from numpy.typing import NDArray

from bladecad.data.scan import Scan
from bladecad.deviation.coverage import Map
from bladecad.deviation.feet import Feet
from bladecad.deviation.nominal import Nominal
from bladecad.deviation.parameters import Number
from bladecad.deviation.referee import Referee
from bladecad.deviation.section_result import SectionResult
from bladecad.deviation.worst import Worst as Worst
from bladecad.deviation.zones import ZoneResult
from bladecad.tolerance import Tolerances

if TYPE_CHECKING:
    from bladecad.deviation.registration import Registration


@final
@dataclass(frozen=True, eq=False)
class Inspection:
    """A scan measured against a nominal.

    nominal, scan : what was compared
    registration  : what moved the scan onto the nominal
    feet          : of the moved points
    zone          : (k,) int8, number in `ZONES` of each point's zone, -1 beyond the span
    zones         : what was found on each zone that the blade has
    map           : the skin in cells, with what the scan did not reach
    sections      : what was found on each station
    worst         : worst places, worst first, each of another neighbourhood
    referee       : what trimesh said to a sample of the distances
    tolerances    : what was allowed
    beyond        : points beyond the span, which have no deviation
    seconds       : that projection, zones, sections and so on took, by name
    """

    nominal: Nominal
    scan: Scan
    registration: Registration
    feet: Feet
    zone: NDArray[np.int8]
    zones: tuple[ZoneResult, ...]
    map: Map
    sections: tuple[SectionResult, ...]
    worst: tuple[Worst, ...]
    referee: Referee | None
    tolerances: Tolerances
    beyond: int
    seconds: dict[str, float]

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why the blade is not good, the zones first; empty where it is."""
        return tuple(self._reasons())

    @property
    def within(self) -> bool:
        """Whether every zone and every number of every section keeps its band."""
        return not self.reasons

    def _reasons(self) -> Iterator[str]:
        for zone in self.zones:
            yield from zone.reasons
        for section in self.sections:
            for number in section.numbers:
                if number.within is False:
                    yield f'section "{section.name}": {_told(number)}'


def _told(number: Number) -> str:
    """One number out of its band, in words."""
    assert number.band is not None
    if number.deviation is None:
        return f"{number.name} is not known: {number.reason}"
    bounds = f"{number.band.lower:+g} .. {number.band.upper:+g} {number.unit}"
    return f"{number.name} is off by {number.deviation:+.4f} {number.unit}, allowed are {bounds}"
