"""Where a line round an airfoil needs freedom: by how far it turns, and by its length."""

from __future__ import annotations

from typing import Final

import numpy as np

from bladecad.arrays import Vector
from bladecad.surface.blade import BladeSurface
from bladecad.surface.loft import SIDES, graded

TURN: Final = 0.3  # rad a span, usually
LENGTH: Final = 1.0 / 24.0  # of the side a span, at most
SHORTEST: Final = 2e-4  # of the side; an edge of 0.1 mm on a chord of 100 mm turns by 0.2 rad
GROWTH: Final = 1.6  # from one span to the next
PLACES: Final = 1500


def breaks_along(surface: BladeSurface, most: float = TURN) -> Vector:
    """Breaks from 0 to 1, for both sides alike: a span turns by `most` at most, rad.

    The tangent turns by pi/2 from an edge to the flank, on any blade, so that the edges get their
    breaks whatever their radius.
    """
    t = graded(PLACES)
    density = np.full(PLACES - 1, 1.0 / LENGTH)
    for name in SIDES:
        T = surface(name, np.linspace(0.05, 0.95, 13), t, 0, 1)
        T /= np.linalg.norm(T, axis=2, keepdims=True)
        turn = np.sqrt((np.linalg.norm(np.diff(T, axis=1), axis=2) ** 2).mean(axis=0))
        density = np.maximum(density, turn / np.diff(t) / most)
    return _spread(t, _tame(t, np.minimum(density, 1.0 / SHORTEST)))


def _tame(t: Vector, density: Vector) -> Vector:
    """Let no span be longer than its neighbour times the growth: |dh/dt| <= growth - 1."""
    h, slope = 1.0 / density, (GROWTH - 1.0) / GROWTH
    middle = 0.5 * (t[1:] + t[:-1])
    rising = np.minimum.accumulate(h - slope * middle) + slope * middle
    falling = np.minimum.accumulate((h + slope * middle)[::-1])[::-1] - slope * middle
    return np.asarray(1.0 / np.minimum(np.minimum(rising, falling), h))


def _spread(t: Vector, density: Vector) -> Vector:
    count = np.concatenate([[0.0], np.cumsum(density * np.diff(t))])
    return np.interp(np.linspace(0.0, count[-1], int(np.ceil(count[-1])) + 1), count, t)
