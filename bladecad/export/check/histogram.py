"""How many points deviate by how much, zone by zone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Vector
from bladecad.deviation.inspecting.inspection import Inspection
from bladecad.deviation.inspecting.zones import ZONES

BINS: Final = 81  # odd: nominal is the middle of one


@final
@dataclass(frozen=True, eq=False)
class Histogram:
    """Points counted by deviation.

    edges  : (n + 1,) float, mm, borders of the bins
    zones  : names, one a row of the counts
    counts : (zones, n) int
    bands  : lower and upper bound of every zone, mm
    below, above : points beyond the bins
    """

    edges: Vector
    zones: tuple[str, ...]
    counts: NDArray[np.int64]
    bands: tuple[tuple[float, float], ...]
    below: int
    above: int

    @property
    def middles(self) -> Vector:
        """Middles of the bins, (n,) mm."""
        return np.asarray(0.5 * (self.edges[1:] + self.edges[:-1]))

    @property
    def beyond(self) -> str:
        """What is not drawn, in words."""
        told = ((self.below, "below"), (self.above, "above"))
        return ", ".join(f"{n:,} points {where} the axis" for n, where in told if n)


def histogram(inspection: Inspection, limit: float) -> Histogram:
    """Count the points of every zone in bins from -1.25 to 1.25 times the limit of the colours."""
    edges = 1.25 * limit * np.linspace(-1.0, 1.0, BINS + 1)
    on = inspection.zone >= 0
    d, zone = inspection.feet.distance[on], inspection.zone[on]
    counts = [np.histogram(d[zone == ZONES.index(one.name)], edges)[0] for one in inspection.zones]
    return Histogram(
        edges,
        tuple(one.name for one in inspection.zones),
        np.array(counts, np.int64).reshape(len(counts), BINS),
        tuple((one.band.lower, one.band.upper) for one in inspection.zones),
        int((d < edges[0]).sum()),
        int((d > edges[-1]).sum()),
    )
