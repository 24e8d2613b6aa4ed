"""The worst places of a scan, each of another neighbourhood."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Points, Vector, seal
from bladecad.deviation.nearest.feet import Feet
from bladecad.surface.blade import SideName
from bladecad.tolerance import ZONES, ZoneName

MANY = 20  # places told
BLOCKS = (60, 120)  # over the span and along a side
APART = 0.05  # of the size of the blade, between two of them


@final
@dataclass(frozen=True, eq=False)
class Worst:
    """One of the worst places: the point furthest out of its band for a neighbourhood around it.

    zone, section    : that it lies on, and name of the nearest station
    side, u, t       : of its foot
    point            : (3,) float, mm, in the frame of the nominal
    index            : number of the point in the scan, from 0
    deviation        : mm, positive outside the metal
    excess           : mm outside the band; negative inside: how much was left
    """

    zone: ZoneName
    section: str
    side: SideName
    u: float
    t: float
    point: Vector
    index: int
    deviation: float
    excess: float

    def __post_init__(self) -> None:
        seal(self, point=(3,))


def worst_places(
    feet: Feet, zone: NDArray[np.int8], excess: Vector, stations: dict[str, float]
) -> tuple[Worst, ...]:
    """Return the points furthest out of their bands, worst first, none near a worse one.

    Parameters
    ----------
    feet, zone, excess : of k points
        Their places, zones, and distances out of the bands, -inf beyond the span.
    stations : names and u of the sections

    Notes
    -----
    Candidates are the worst points of blocks much smaller than a neighbourhood; a place nearer
    than a twentieth of the blade's size to a worse one is the same place.
    """
    block = _blocks(feet)
    top = np.full(2 * BLOCKS[0] * BLOCKS[1], -np.inf)
    np.maximum.at(top, block, excess)
    found = np.flatnonzero((excess == top[block]) & np.isfinite(excess))
    found = found[np.argsort(-excess[found], kind="stable")]
    near = APART * float(np.linalg.norm(np.ptp(feet.foot[found], axis=0))) if len(found) else 0.0
    chosen = found[_apart(feet.foot[found], near)]
    return tuple(_worst(feet, int(k), int(zone[k]), float(excess[k]), stations) for k in chosen)


def _blocks(feet: Feet) -> NDArray[np.int32]:
    """Number of the block of u and t that each foot lies on, (k,)."""
    a, b = BLOCKS
    i = np.minimum((feet.u * a).astype(np.int32), a - 1)
    j = np.minimum((feet.t * b).astype(np.int32), b - 1)
    return np.asarray((i + np.where(feet.suction, 0, a)) * b + j, dtype=np.int32)


def _apart(points: Points, near: float) -> list[int]:
    """Numbers of points, from the first on, none of them near an earlier one."""
    free = np.arange(len(points))
    chosen: list[int] = []
    while len(free) and len(chosen) < MANY:
        chosen.append(int(free[0]))
        away = points[free] - points[free[0]]
        free = free[np.einsum("kx,kx->k", away, away) > near**2]
    return chosen


def _worst(feet: Feet, k: int, zone: int, out: float, stations: dict[str, float]) -> Worst:
    u = float(feet.u[k])
    return Worst(
        zone=ZONES[zone],
        section=min(stations, key=lambda name: abs(stations[name] - u)),
        side="suction" if feet.suction[k] else "pressure",
        u=u,
        t=float(feet.t[k]),
        point=feet.foot[k] + feet.distance[k] * feet.normal[k],
        index=k,
        deviation=float(feet.distance[k]),
        excess=out,
    )
