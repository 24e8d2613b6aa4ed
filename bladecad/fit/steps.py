"""Parameters for points: equal steps, or steps in proportion to the distance, eq. (8)."""

from __future__ import annotations

from typing import Literal, TypeAlias

import numpy as np

from bladecad.arrays import Points, Vector
from bladecad.errors import DataError

Spacing: TypeAlias = Literal["uniform", "arc-length"]

EPS = float(np.finfo(np.float64).eps)


def uniform_steps(k: int) -> Vector:
    """Return k - 1 equal steps that sum to 1.

    The paper sets dt = 1. That only renames time: A is k - 1 times smaller, the curve is the same.
    """
    return np.full(k - 1, 1.0 / (k - 1))


def arc_length_steps(points: Points) -> Vector:
    """Return steps in proportion to the distance between neighbours, summing to 1, eq. (8)."""
    gaps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    if not gaps.all():
        at = int(np.argmin(gaps))
        raise DataError(f"points {at} and {at + 1} coincide; remove one of them")
    return np.asarray(gaps / gaps.sum())


def steps_of(points: Points, spacing: Spacing) -> Vector:
    """Return the steps of the points, by name."""
    return uniform_steps(len(points)) if spacing == "uniform" else arc_length_steps(points)


def parameters(steps: Vector) -> Vector:
    """Return t of every point, from 0; the last is exactly 1 where rounding alone is in the way."""
    t = np.append(0.0, np.cumsum(steps))
    return np.where(np.abs(t - 1.0) < len(t) * EPS, 1.0, t)
