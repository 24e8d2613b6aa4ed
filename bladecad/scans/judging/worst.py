"""Where a scan is furthest from the surface fitted to it, and why, where that can be known."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from bladecad.arrays import Vector
from bladecad.deviation.inspecting.worst import Worst, worst_places
from bladecad.deviation.inspecting.zones import zone_of
from bladecad.deviation.nearest.feet import Feet
from bladecad.scans.judging.support import Gap
from bladecad.scans.judging.systematic import LEVELS, Cells, cells_of
from bladecad.tolerance import EDGE_ZONE, uniform

SHOWN: Final = 5
RIM: Final = 0.02  # of the span
BESIDE: Final = 0.02  # of span and side: so near a gap, a place is beside it
FULL: Final = 10  # points of the cells that a place is told by, at least in the mean
CROWD: Final = 0.25  # share set aside, from which outliers of a cell belong together,
TOGETHER: Final = 4  # and how many they must be: at 1 % outliers, chance in 1 of 500,000 cells
ROUGH: Final = 2.0  # times the noise: scatter that is more than noise
CHANCE: Final = 5.0  # sigmas: one point of 1.7 million is further off


@final
@dataclass(frozen=True, eq=False)
class WorstPlace:
    """One of the places with the largest deviations.

    place   : side, u, t, point and deviation
    mean, scatter : mm, of the points of its cell
    points  : in that cell
    set_aside : of these, as outliers
    why     : a sentence, empty where nothing is known
    """

    place: Worst
    mean: float
    scatter: float
    points: int
    set_aside: int
    why: str


def worst_of_scan(
    feet: Feet, weight: Vector, gaps: Sequence[Gap], noise: float
) -> tuple[WorstPlace, ...]:
    """Return the places where points are furthest off, worst first; lone outliers are no place.

    Parameters
    ----------
    feet, weight : of k points
        Their places, and robust weights.
    gaps : sequence of Gap
    noise : float
        mm, one sigma.
    """
    a, b = _shape(len(weight))
    cell = cells_of(feet, a, b)
    n = 2 * a * b
    total, out = np.bincount(cell, minlength=n), np.bincount(cell[weight <= 0.0], minlength=n)
    together = (weight > 0.0) | ((out >= CROWD * total) & (out >= TOGETHER))[cell]
    size = np.where(together & ~feet.rim, np.abs(feet.distance), -np.inf)
    bands = uniform(1.0)
    found = worst_places(feet, zone_of(feet, bands), size, {"": 0.0})[:SHOWN]
    return tuple(_explained(one, feet, weight, cell, gaps, noise) for one in found)


def _shape(count: int) -> tuple[int, int]:
    """Cells as fine as they hold ten points in the mean."""
    fine = [shape for shape in LEVELS if 2 * shape[0] * shape[1] * FULL <= count]
    return fine[0] if fine else LEVELS[-1]


def _explained(
    one: Worst, feet: Feet, weight: Vector, cell: Cells, gaps: Sequence[Gap], noise: float
) -> WorstPlace:
    here = cell == cell[one.index]
    d, aside = feet.distance[here], int((weight[here] <= 0.0).sum())
    scatter = float(d.std()) if len(d) > 1 else 0.0
    why = "; ".join(_why(one, d, aside, scatter, gaps, noise))
    return WorstPlace(one, float(d.mean()), scatter, len(d), aside, why)


def _why(
    one: Worst, d: Vector, aside: int, scatter: float, gaps: Sequence[Gap], noise: float
) -> Iterator[str]:
    if aside >= max(TOGETHER, CROWD * len(d)):
        yield (
            f"{aside} of {len(d)} points here stand off together and were set aside: dirt, a "
            "burr, or a feature that is no airfoil"
        )
    for number, gap in enumerate(gaps, 1):
        if gap.side == one.side and _beside(one, gap):
            yield f"beside gap {number}, where no point holds the surface"
    if min(one.u, 1.0 - one.u) < RIM:
        yield f"near the {'hub' if one.u < 0.5 else 'tip'} rim, where the airfoil was cut off"
    if min(one.t, 1.0 - one.t) < EDGE_ZONE:
        yield f"at the {'leading' if one.t < 0.5 else 'trailing'} edge"
    if abs(one.deviation) <= CHANCE * noise:
        yield f"noise: {abs(one.deviation) / noise:.1f} sigma, among so many points"
    elif scatter > ROUGH * noise > 0.0:
        yield (
            f"the scan is rough here: points scatter by {1e3 * scatter:.2g} um, by "
            f"{1e3 * noise:.2g} um elsewhere"
        )
    elif not aside and abs(d.mean()) <= noise:
        mean = 1e3 * d.mean()
        yield f"alone: the {len(d)} points of this place are off by {mean:+.2g} um in the mean"


def _beside(one: Worst, gap: Gap) -> bool:
    return (
        gap.u[0] - BESIDE <= one.u <= gap.u[1] + BESIDE
        and gap.t[0] - BESIDE <= one.t <= gap.t[1] + BESIDE
    )
