"""A blade set up for those who ask where the machine is: a scan lies anywhere."""

from __future__ import annotations

from typing import Final

import numpy as np

from bladecad.arrays import Array, Points, Vector

ALONG: Final = 0.95  # cosine from which on a direction is no machine axis across the span
AWAY: Final = 20.0  # times the span: as far from the machine axis is the blade set up


def upright(axis: Vector, points: Points) -> Array:
    """Stand a blade far from a machine axis, its stacking axis pointing away from it.

    `repaired` and `split_sides` lay sections flat about the machine axis; were it where the scan's
    happens to be, it could run through the blade, and they would be torn apart.

    Parameters
    ----------
    axis : (3,) float, unit
        Stacking axis.
    points : (k, 3) float, mm
        Of the blade.

    Returns
    -------
    (4, 4) float
        The rigid motion after which z is the machine axis and the blade stands along x.
    """
    z = np.eye(3)[2] if abs(axis[2]) < ALONG else np.eye(3)[0]
    away = AWAY * float(np.ptp(points @ axis))
    return motion(across(z, axis), axis, points.mean(axis=0) - away * axis)


def motion(z: Vector, x: Vector, origin: Vector) -> Array:
    """The rigid motion that brings unit vectors z and x, across each other, to the axes, (4, 4)."""
    rows = np.stack([x, np.cross(z, x), z])
    move = np.eye(4)
    move[:3, :3], move[:3, 3] = rows, -rows @ origin
    return move


def across(v: Vector, axis: Vector) -> Vector:
    """The unit direction of what is left of v across an axis, (3,)."""
    rest = v - (v @ axis) * axis
    return np.asarray(rest / np.linalg.norm(rest))
