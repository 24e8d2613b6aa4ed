"""The two ends of the blade: a plane where the end section is planar, else ruled."""

from __future__ import annotations

import numpy as np

from bladecad.arrays import Array, Points
from bladecad.surface.patch import SplinePatch

LINE = np.array([0.0, 0.0, 1.0, 1.0])


def cap(suction: SplinePatch, pressure: SplinePatch, row: int) -> SplinePatch:
    """Rule the end section, row 0 (hub) or -1 (tip): u from suction to pressure, t unchanged."""
    poles = np.stack([suction.poles[row], pressure.poles[row]], axis=0)
    return SplinePatch(poles, LINE, suction.knots_t, 1, suction.degree_t)


def edge_strip(suction: SplinePatch, pressure: SplinePatch, column: int) -> SplinePatch:
    """Rule a blunt edge, column 0 (leading) or -1: t from suction to pressure, u unchanged."""
    poles = np.stack([suction.poles[:, column], pressure.poles[:, column]], axis=1)
    return SplinePatch(poles, suction.knots_u, LINE, suction.degree_u, 1)


def best_plane(points: Points) -> tuple[Points, Points, float]:
    """Return a point of the plane closest to the points, its normal, and the largest distance."""
    middle = points.mean(axis=0)
    normal = np.linalg.svd(points - middle, full_matrices=False)[2][2]
    return middle, normal, float(np.abs((points - middle) @ normal).max())


def flatten_ends(
    suction: SplinePatch, pressure: SplinePatch, planar: float
) -> tuple[SplinePatch, SplinePatch, tuple[bool, bool]]:
    """Drop end sections that are planar to within `planar` mm exactly onto their plane.

    Returns
    -------
    suction, pressure : SplinePatch
        Moved at most `planar` mm, and only within the knot spans next to the end.
    plane : (bool, bool)
        Whether hub and tip are now planar.
    """
    sides = np.stack([suction.poles, pressure.poles])
    flat = (_flatten(sides, 0, planar), _flatten(sides, -1, planar))
    return _with_poles(suction, sides[0]), _with_poles(pressure, sides[1]), flat


def _flatten(sides: Array, row: int, planar: float) -> bool:
    end = sides[:, row]
    middle, normal, distance = best_plane(end.reshape(-1, 3))
    if distance > planar:
        return False
    shared = [column for column in (0, -1) if np.array_equal(end[0, column], end[1, column])]
    end -= ((end - middle) @ normal)[..., None] * normal
    end[1, shared] = end[0, shared]
    return True


def _with_poles(patch: SplinePatch, poles: Array) -> SplinePatch:
    return SplinePatch(poles, patch.knots_u, patch.knots_t, patch.degree_u, patch.degree_t)
