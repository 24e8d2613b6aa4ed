"""What kind an edge of two patches is, and how far it reaches."""

from __future__ import annotations

from typing import Final

import numpy as np

from bladecad.arrays import Array, Vector
from bladecad.surface.blade import EdgeKind
from bladecad.surface.patch import SplinePatch

CORNER: Final = np.radians(1.0)  # sides that meet at a larger angle are meant to have a corner
ABREAST: Final = np.radians(30.0)  # between the sides where an edge ends and the body begins
WIDEST: Final = 0.15  # an edge, in t


def edge_kind(suction: SplinePatch, pressure: SplinePatch, column: int) -> EdgeKind:
    """Tell a blunt edge, where the sides are apart, from a corner and from a round one.

    column : 0 for the leading edge, -1 for the trailing edge
    """
    if not np.array_equal(suction.poles[:, column], pressure.poles[:, column]):
        return "blunt"
    u, end = _places(suction.knots_u), suction.knots_t[[column]]
    along, back = suction(u, end, 0, 1)[:, 0], -pressure(u, end, 0, 1)[:, 0]
    return "sharp" if _angles(along, back).max() > CORNER else "round"


def border(suction: SplinePatch, pressure: SplinePatch, column: int) -> float:
    """Return the first knot from the edge at which the sides run abreast at every u.

    column : 0 for the leading edge, -1 for the trailing edge
    """
    u, knots = _places(suction.knots_u), np.unique(suction.knots_t)
    t = knots if column == 0 else knots[::-1]
    between = _angles(suction(u, t, 0, 1), pressure(u, t, 0, 1)).max(axis=0)
    enough = (between <= ABREAST) | (np.abs(t - t[0]) > WIDEST)
    enough[:2] = False  # a zone has room for two knots at least
    return float(t[np.argmax(enough)])


def _angles(a: Array, b: Array) -> Vector:
    """Angles between vectors in the last axis, radians."""
    sine = np.linalg.norm(np.cross(a, b), axis=-1)
    return np.asarray(np.arctan2(sine, np.einsum("...x,...x->...", a, b)))


def _places(knots: Vector) -> Vector:
    breaks = np.unique(knots)
    return np.union1d(breaks, 0.5 * (breaks[1:] + breaks[:-1]))
