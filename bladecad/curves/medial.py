"""The camber line of a loop from its inscribed circles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from bladecad.arrays import Array, Points, Vector, seal

SHRINKS = 30
SAME_BALL = 1e-9  # relative change of radius at which a ball has stopped shrinking


@final
@dataclass(frozen=True, eq=False)
class Medial:
    """The inscribed circle that touches a flat loop at each of its points.

    centres : (n, 2) float, mm
    radii   : (n,) float, mm
    partner : (n,) float; number of the loop point where the circle touches again
    opening : (n,) float; angle between the two touching radii, pi where the sides run parallel
    """

    centres: Points
    radii: Vector
    partner: Vector
    opening: Vector

    def __post_init__(self) -> None:
        n = len(self.radii)
        seal(self, centres=(n, 2), radii=(n,), partner=(n,), opening=(n,))


def inscribed(loop: Points, tangents: Array) -> Medial:
    """Shrink, at every point of a flat closed loop, a circle until it is empty.

    Parameters
    ----------
    loop : (n, 2) float, mm
        Dense against the edge radii, counter-clockwise.
    tangents : (n, 2) float
        Unit tangents in loop order.

    Notes
    -----
    Shrinking-ball algorithm, Ma, Bae and Choi, The Visual Computer 28 (2012): from a ball too
    large, r = |p - q|^2 / (2 n.(q - p)) with q the loop point nearest to the centre, until no
    point lies inside. Needs no first guess of edges or sides.
    """
    n_in = np.column_stack([-tangents[:, 1], tangents[:, 0]])
    tree = cKDTree(loop)
    r = np.full(len(loop), 0.5 * float(np.linalg.norm(np.ptp(loop, axis=0))))
    q = np.arange(len(loop))
    active = np.arange(len(loop))
    for _ in range(SHRINKS):
        middle = loop[active] + r[active, None] * n_in[active]
        near = np.asarray(tree.query(middle, workers=-1)[1])  # slow: all is as far from a middle
        d = loop[near] - loop[active]
        away = 2.0 * np.einsum("kd,kd->k", n_in[active], d)
        ball = np.einsum("kd,kd->k", d, d) / np.where(away > 0, away, np.inf)
        shrunk = (near != active) & (away > 0) & (ball < r[active] * (1.0 - SAME_BALL))
        active = active[shrunk]
        r[active], q[active] = ball[shrunk], near[shrunk]
        if len(active) == 0:
            break
    centres = loop + r[:, None] * n_in
    return Medial(centres, r, q.astype(float), _opening(loop, centres, q))


def counter_clockwise(flat: Points) -> Vector:
    """Factors (1, +-1) that turn a flat loop counter-clockwise, mirroring it if need be."""
    x, y = flat.T
    area = np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)
    return np.array([1.0, 1.0 if area > 0 else -1.0])


def tangents(loop: Points) -> Array:
    """Unit tangents of a closed loop of uneven spacing, of second order, (n, 2)."""
    ahead = np.roll(loop, -1, axis=0) - loop
    h = np.linalg.norm(ahead, axis=1)[:, None]
    behind, h0 = np.roll(ahead, 1, axis=0), np.roll(h, 1, axis=0)
    T = ahead * (h0 / h) + behind * (h / h0)
    return np.asarray(T / np.linalg.norm(T, axis=1)[:, None])


def _opening(loop: Points, centres: Points, partner: NDArray[np.intp]) -> Vector:
    a, b = loop - centres, loop[partner] - centres
    cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return np.asarray(np.abs(np.arctan2(cross, np.einsum("kd,kd->k", a, b))))
