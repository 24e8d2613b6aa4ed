"""The zones of a blade, and what was found on each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from bladecad.tolerance import ZONES as ZONES
from bladecad.tolerance import Band, ZoneName


@final
@dataclass(frozen=True)
class ZoneResult:
    """One zone: points and area, in and out of tolerance.

    name, band     : of the zone
    points         : how many lie on it
    out_points     : of them outside the band
    area           : mm^2
    measured_area  : mm^2, of the cells that the scan reaches
    out_area       : mm^2, outside the band: of each cell the share of its points that is
    lowest, highest, mean, rms, p99 : of the deviations, mm; p99 of their sizes; NaN without points
    allowed_out    : share of the points that may be out
    least_coverage : share of the area that must be measured
    """

    name: ZoneName
    band: Band
    points: int
    out_points: int
    area: float
    measured_area: float
    out_area: float
    lowest: float
    highest: float
    mean: float
    rms: float
    p99: float
    allowed_out: float = 0.0
    least_coverage: float = 0.0

    @property
    def coverage(self) -> float:
        """Share of the area that is measured."""
        return self.measured_area / self.area

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why the zone is not good; empty where it is."""
        if not self.points:
            return (f"the {self.name} has no point: it is not measured",)
        found = []
        if self.out_points > self.allowed_out * self.points:
            found.append(
                f"{self.out_points} of {self.points} points of the {self.name} are out of "
                f"{self.band.lower:+g} .. {self.band.upper:+g} mm, from {self.lowest:+.4f} to "
                f"{self.highest:+.4f} mm, {100 * self.allowed_out:g} % may be"
            )
        if self.coverage < self.least_coverage:
            found.append(
                f"{100 * self.coverage:.1f} % of the {self.name} is measured, "
                f"{100 * self.least_coverage:g} % must be"
            )
        return tuple(found)

    @property
    def within(self) -> bool:
        """Whether points and coverage are as the tolerances ask."""
        return not self.reasons
