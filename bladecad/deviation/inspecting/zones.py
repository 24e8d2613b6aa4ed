"""The zones of a blade, and what was found on each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Mask, Vector
from bladecad.deviation.inspecting.coverage import Map
from bladecad.deviation.nearest.feet import Feet
from bladecad.tolerance import ZONES as ZONES
from bladecad.tolerance import Band, Tolerances, ZoneName


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


def zone_of(feet: Feet, tolerances: Tolerances) -> NDArray[np.int8]:
    """Number in `ZONES` of the zone that every foot lies on, (k,); -1 beyond the span.

    The margins at hub and tip take what lies on them, then the edges, then the sides; the face of
    a cut-off edge belongs to its edge.
    """
    zone = _at(feet.suction, feet.u, feet.t, tolerances)
    for face, number, width in ((2, 2, tolerances.le_zone), (3, 3, tolerances.te_zone)):
        if width > 0.0:
            zone[(feet.face == face) & (zone < number)] = number
    zone[feet.rim] = -1
    return zone


def _at(suction: Mask, u: Vector, t: Vector, tolerances: Tolerances) -> NDArray[np.int8]:
    """Zone of places on the sides, of any one shape."""
    zone = np.where(suction, np.int8(0), np.int8(1))
    zone[t < tolerances.le_zone] = 2
    zone[t > 1.0 - tolerances.te_zone] = 3
    zone[u < tolerances.hub_margin] = 4
    zone[u > 1.0 - tolerances.tip_margin] = 5
    return zone


def excess(distance: Vector, zone: NDArray[np.int8], tolerances: Tolerances) -> Vector:
    """How far each point is out of the band of its zone, mm, (k,).

    Negative inside: what is left to the nearer limit. Beyond the span -inf.
    """
    bands = [tolerances.zones.get(name) for name in ZONES]
    lower = np.array([band.lower if band else -np.inf for band in bands] + [-np.inf])
    upper = np.array([band.upper if band else np.inf for band in bands] + [np.inf])
    out = np.maximum(distance - upper[zone], lower[zone] - distance)
    return np.asarray(out)


def zone_results(
    feet: Feet, zone: NDArray[np.int8], out: Mask, map_: Map, tolerances: Tolerances
) -> tuple[ZoneResult, ...]:
    """Count points and area of every zone that the blade has.

    Parameters
    ----------
    feet, zone, out : of k points
        Their places, zones, and whether each is out of the band of its zone.
    map_ : Map
        Cells that respect the zones.
    """
    side = np.array([True, False])[:, None, None]
    u, t = _middles(map_.u)[:, None], _middles(map_.t)
    side, u, t = np.broadcast_arrays(side, u, t)
    cells = _at(side, u, t, tolerances)
    share = _share_out(feet, zone, out, map_)
    return tuple(
        _result(name, feet.distance[zone == k], out[zone == k], cells == k, share, map_, tolerances)
        for k, name in enumerate(ZONES)
        if name in tolerances.present
    )


def _result(
    name: ZoneName, d: Vector, out: Mask, cells: Mask, share: Array, map_: Map, tol: Tolerances
) -> ZoneResult:
    area = map_.area[cells]
    return ZoneResult(
        name,
        tol.zones[name],
        len(d),
        int(np.count_nonzero(out)),
        float(area.sum()),
        float(area[map_.measured[cells]].sum()),
        float(area @ share[cells]),
        *_statistics(d),
        tol.allowed_out,
        tol.coverage.get(name, 0.0),
    )


def _statistics(d: Vector) -> tuple[float, float, float, float, float]:
    if not len(d):
        return (np.nan,) * 5
    rms, p99 = np.sqrt(d @ d / len(d)), np.quantile(np.abs(d), 0.99)
    return float(d.min()), float(d.max()), float(d.mean()), float(rms), float(p99)


def _share_out(feet: Feet, zone: NDArray[np.int8], out: Mask, map_: Map) -> Array:
    """Share of each cell's points that are out, (2, a, b); of its neighbours' where it has none."""
    counted = out & (zone >= 0)
    bad = np.bincount(map_.cell(feet[counted]), minlength=map_.count.size).reshape(map_.count.shape)
    near_bad, near = _with_neighbours(bad), _with_neighbours(map_.count)
    share = np.where(
        map_.count > 0, bad / np.maximum(map_.count, 1), near_bad / np.maximum(near, 1)
    )
    return np.where(map_.measured, share, 0.0)


def _with_neighbours(count: NDArray[np.int64]) -> NDArray[np.int64]:
    """Sum over each cell and the four beside it."""
    wide = np.pad(count, ((0, 0), (1, 1), (1, 1)))
    ring = wide[:, :-2, 1:-1] + wide[:, 2:, 1:-1] + wide[:, 1:-1, :-2] + wide[:, 1:-1, 2:]
    return ring + count


def _middles(borders: Vector) -> Vector:
    return np.asarray(0.5 * (borders[1:] + borders[:-1]))
