"""Cylindrical coordinates about the axis of the machine: axial position, radius, angle."""

from __future__ import annotations

import numpy as np

from bladecad.arrays import Array


def to_cylinder(points: Array, axis: int, angle: float = 0.0) -> Array:
    """Axial position, radius and angle of points, (..., 3) mm, mm, radians.

    Parameters
    ----------
    points : (..., 3) float, mm
    axis : int
        Column of the machine axis, which passes through the origin.
    angle : float
        Angles are given within half a turn of this one, so that a blade there is in one piece.

    Notes
    -----
    theta turns by the right hand about the axis: from x to y about z, y to z about x, z to x
    about y.
    """
    first, second = points[..., (axis + 1) % 3], points[..., (axis + 2) % 3]
    theta = np.arctan2(second, first)
    theta = angle + np.remainder(theta - angle + np.pi, 2.0 * np.pi) - np.pi
    return np.stack([points[..., axis], np.hypot(first, second), theta], axis=-1)


def from_cylinder(zrt: Array, axis: int) -> Array:
    """Points of axial position, radius and angle, (..., 3), mm."""
    points = np.empty_like(zrt)
    points[..., axis] = zrt[..., 0]
    points[..., (axis + 1) % 3] = zrt[..., 1] * np.cos(zrt[..., 2])
    points[..., (axis + 2) % 3] = zrt[..., 1] * np.sin(zrt[..., 2])
    return points


def turned(points: Array, axis: int, angle: float) -> Array:
    """Points turned about the axis, (..., 3), mm."""
    c, s = np.cos(angle), np.sin(angle)
    R = np.zeros((3, 3))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R[axis, axis] = 1.0
    R[i, i], R[i, j], R[j, i], R[j, j] = c, -s, s, c
    return np.asarray(np.einsum("ij,...j->...i", R, points))
