"""How far a side is from a ruled surface, and how its normal twists: flank milling or not."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from bladecad.arrays import Array, Mask, Vector, seal
from bladecad.cam.rulings import Rulings, V, side_skin
from bladecad.deviation.nearest.skin import search
from bladecad.splines import basis, clamped
from bladecad.surface.blade import BladeSurface, SideName
from bladecad.tolerance import EDGE_ZONE

RULINGS: Final = 81
SPANS: Final = 12  # of the splines that lay the rulings
STEPS: Final = 30
SLOWER, FASTER = 4.0, 3.0  # of the damping after a step that failed, and one that helped
EXACT, STIFF = 1e-9, 1e5  # mm; and the damping at which no step helps
SLACK: Final = 1e-9  # of t: a foot on the border of a zone
STILL: Final = 1e-3  # relative change of the sum of squares at which nothing gets better


@final
@dataclass(frozen=True, eq=False)
class Flank:
    """One side against its best ruled surface, between the edge zones.

    side      : "suction" or "pressure"
    t, ends   : (k,) float; a ruling runs from the hub at t to the tip at ends
    v         : (m,) float, place along the rulings, 0 at the hub and 1 at the tip
    deviation : (m, k) float, mm; of the rulings from the side along its normal, positive where
                they run outside the metal
    counted   : (m, k) bool; False where the nearest place lies in an edge zone
    twist     : (k,) float, radians; largest angle between normals of the side along a ruling, at
                places that count
    """

    side: SideName
    t: Vector
    ends: Vector
    v: Vector
    deviation: Array
    counted: Mask
    twist: Vector

    def __post_init__(self) -> None:
        m, k = len(self.v), len(self.t)
        seal(self, t=(k,), ends=(k,), v=(m,), deviation=(m, k), twist=(k,))

    @property
    def largest(self) -> float:
        """Largest deviation, mm."""
        return float(np.abs(self.deviation[self.counted]).max())

    @property
    def rms(self) -> float:
        """Root mean square of the deviation, mm."""
        return float(np.sqrt(np.mean(self.deviation[self.counted] ** 2)))

    def overcut(self, radius: float) -> float:
        """How deep a cylinder laid along a ruling cuts at its ends, R (1 - cos(twist / 2)), mm.

        The axis is R above the ruling along the normal half-way between the extreme ones, so at
        these it is R cos(twist / 2) above the tangent plane.
        """
        return radius * (1.0 - float(np.cos(0.5 * self.twist.max())))

    def error(self, radius: float) -> float:
        """What flank milling with a cylinder of that radius cannot reach, mm: both together."""
        return self.largest + self.overcut(radius)


def flank(surface: BladeSurface, side: SideName) -> Flank:
    """Lay the ruled surface that is nearest to a side, by least squares along the normal.

    A ruling starts at the hub at t, off it by alpha(t) along the normal, and ends at the tip at
    b(t), off it by beta(t): all three are cubic splines. Least squares of the distance of points
    of the rulings from their feet, by Levenberg's and Marquardt's steps. Edge zones, 2 % of the
    side, do not count: edges are not milled by the flank.

    Parameters
    ----------
    surface : BladeSurface
    side : {"suction", "pressure"}
    """
    breaks = np.linspace(EDGE_ZONE, 1.0 - EDGE_ZONE, SPANS + 1)
    t = np.linspace(breaks[0], breaks[-1], RULINGS)
    M = basis(clamped(breaks, 3), 3, t)
    lay = Rulings(surface, side, side_skin(surface, side), t, M)
    return _measured(lay, _least(lay, np.zeros((3, M.shape[1]))))


def _least(lay: Rulings, c: Array) -> Array:
    """Levenberg's and Marquardt's way down; a step that does not help is taken shorter."""
    r, J, hold = lay.linear(c)
    damping = 1.0
    for _ in range(STEPS):
        if np.abs(r).max() < EXACT or damping > STIFF:
            break
        step = lay.step(c, r, J, hold, damping)
        tried = lay.linear(c + step) if lay.in_order(c + step) else None
        if tried is None or not np.sum(tried[0] ** 2) < np.sum(r**2):
            damping *= SLOWER
            continue
        gained = 1.0 - np.sum(tried[0] ** 2) / max(np.sum(r**2), 1e-300)
        c, (r, J, hold), damping = c + step, tried, damping / FASTER
        if gained < STILL:
            break
    return c


def _measured(lay: Rulings, c: Array) -> Flank:
    X, *_, b = lay.laid(c)
    found = search(lay.skin, X.reshape(-1, 3))
    n = found.normal.reshape(X.shape)
    t = lay.t_of(found).reshape(n.shape[:2])
    counted = (t >= EDGE_ZONE - SLACK) & (t <= 1.0 - EDGE_ZONE + SLACK)
    cos = np.einsum("akx,bkx->abk", n, n)
    cos = np.where(counted[:, None] & counted, cos, 1.0).min(axis=(0, 1))
    twist = np.arccos(np.clip(cos, -1.0, 1.0))
    return Flank(lay.side, lay.t, b, V, found.distance.reshape(t.shape), counted, twist)
