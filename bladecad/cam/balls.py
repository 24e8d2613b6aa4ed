"""Balls that touch a blade from inside or outside: how thick it is, how large a cutter may be."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from bladecad.arrays import Points, Vector, seal
from bladecad.deviation.nearest.skin import Skin, search

SHRINKS: Final = 60
SAME: Final = 1e-7  # relative change of radius at which a ball has stopped shrinking
SLIGHT: Final = 1e-7  # mm; a ball that goes in no deeper is empty


@final
@dataclass(frozen=True, eq=False)
class Balls:
    """The largest empty ball that touches a skin at each of some places.

    radius : (k,) float, mm
    other  : (k, 3) float, mm, where it touches again; the place itself where the curvature there,
             or the largest ball that was asked about, bounds it
    """

    radius: Vector
    other: Points

    def __post_init__(self) -> None:
        seal(self, radius=(None,), other=(len(self.radius), 3))


def balls(skin: Skin, points: Points, directions: Points, most: Vector) -> Balls:
    """Shrink balls that touch a skin until they are empty.

    Parameters
    ----------
    skin : Skin
    points : (k, 3) float, mm, on the skin
    directions : (k, 3) float, unit, from each point to the centre of its ball
    most : (k,) float, mm
        Radius to begin with: that of curvature, or what would be large enough.

    Notes
    -----
    Shrinking-ball algorithm, Ma, Bae and Choi, The Visual Computer 28 (2012): the ball through p
    with its centre along n that also meets q has r = |q - p|^2 / (2 n . (q - p)); q is the foot of
    the centre on the exact skin, until that is no nearer than p.
    """
    r, other = np.array(most, dtype=np.float64), np.array(points, dtype=np.float64)
    active = np.arange(len(points))
    for _ in range(SHRINKS):
        p, n = points[active], directions[active]
        found = search(skin, p + r[active, None] * n)
        q, into = found.foot, r[active] - np.abs(found.distance)
        away = q - p
        square, along = (np.einsum("kx,kx->k", away, v) for v in (away, n))
        there = (along > 0.0) & (into > SLIGHT)
        smaller = np.where(there, square / np.where(there, 2.0 * along, 1.0), np.inf)
        shrunk = smaller < r[active] * (1.0 - SAME)
        active, q = active[shrunk], q[shrunk]
        if len(active) == 0:
            break
        r[active], other[active] = smaller[shrunk], q
    return Balls(r, other)
