"""A number of a section: nominal, actual, uncertainty, and the band it must keep."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, final

from bladecad.tolerance import Band


@final
@dataclass(frozen=True)
class Number:
    """One number of one section.

    name        : as in `ParameterName`; a thickness also tells its place, "... at 0.5 mm"
    unit        : "mm" or "deg"
    nominal     : of the nominal section, by the same formula; None if the section has none
    actual      : of the measured section; None where the points do not tell it
    uncertainty : half width of the 95 % interval of `actual`; None with it
    band        : what `deviation` must keep, or None
    reason      : why there is no nominal or no actual, else ""
    """

    name: str
    unit: Literal["mm", "deg", ""]
    nominal: float | None
    actual: float | None
    uncertainty: float | None
    band: Band | None = None
    reason: str = ""

    @property
    def deviation(self) -> float | None:
        """Actual less nominal; None if either is not known."""
        if self.actual is None or self.nominal is None:
            return None
        return self.actual - self.nominal

    @property
    def within(self) -> bool | None:
        """Whether the deviation keeps its band; None without a band.

        A number with a band that the points do not tell is not within it.
        """
        if self.band is None:
            return None
        return self.deviation is not None and self.deviation in self.band

    @property
    def sure(self) -> bool | None:
        """Whether all of the 95 % interval says the same as `within`; None without a band."""
        if self.band is None:
            return None
        if self.deviation is None or self.uncertainty is None:
            return False
        ends = (self.deviation - self.uncertainty, self.deviation + self.uncertainty)
        if self.within:
            return all(end in self.band for end in ends)
        return ends[0] > self.band.upper or ends[1] < self.band.lower
