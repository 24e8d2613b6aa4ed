"""Edge circles and the points between them become one smooth side."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.optimize import minimize_scalar

from bladecad.arrays import Array, Vector

ARC = 12  # points on each side of an edge circle
GROWTH = 1.4  # of the spacing, from the arc to the first tabulated point
SEARCH = 0.5  # rad, either way of the straight tangent
NEAR = 4  # points that decide how the side leaves the circle

MIRROR_L, MIRROR_H = np.array([-1.0, 1.0]), np.array([1.0, -1.0])


class Circle(NamedTuple):
    """An edge circle in the (l, h) plane of a section."""

    l: float  # noqa: E741
    h: float
    radius: float

    def mirrored(self, mirror: Vector) -> Circle:
        """Return the circle with an axis reversed."""
        return Circle(self.l * mirror[0], self.h * mirror[1], self.radius)

    @property
    def centre(self) -> Vector:
        """Return (l, h)."""
        return np.array([self.l, self.h])

    def at(self, lean: Vector) -> Array:
        """Return the points whose tangent leans up by so much: 0 the top, pi/2 the foremost."""
        normal: Array = np.column_stack([-np.sin(lean), np.cos(lean)])
        return self.centre + self.radius * normal


def upper_side(points: Array, le: Circle, te: Circle) -> Array:
    """Return an upper side from the foremost point of `le` to the hindmost of `te`.

    Each circle is left tangentially, in the direction from which the spline through the points
    bends least. Points on the arcs are even; on to the first given point the spacing grows.

    Parameters
    ----------
    points : (n, 2) float
        Between the circles, from the leading edge on.
    """
    front, lean_le = _arc(points, le)
    back, lean_te = _arc(points[::-1] * MIRROR_L, te.mirrored(MIRROR_L))
    back = back[::-1] * MIRROR_L
    side = _spline(np.vstack([front[-1], points, back[0]]), lean_le, -lean_te)
    first = _graded(side.x[1], float(np.linalg.norm(front[-1] - front[-2])))
    last = side.x[-1] - _graded(side.x[-1] - side.x[-2], float(np.linalg.norm(back[1] - back[0])))
    return np.vstack([front, side(first), points, side(last[::-1]), back])


def lower_side(points: Array, le: Circle, te: Circle) -> Array:
    """Return a lower side, likewise."""
    mirrored = upper_side(points * MIRROR_H, le.mirrored(MIRROR_H), te.mirrored(MIRROR_H))
    side: Array = mirrored * MIRROR_H
    return side


def _arc(points: Array, circle: Circle) -> tuple[Array, float]:
    """Return the arc from the foremost point to where the side leaves it, and the lean there."""
    l, h = points[0] - circle.centre  # noqa: E741
    straight = np.arctan2(h, l) - np.arcsin(circle.radius / np.hypot(l, h))
    lean = minimize_scalar(
        lambda lean: _bending(lean, points[:NEAR], circle),
        bounds=(straight - SEARCH, min(straight + SEARCH, np.pi / 2)),
        method="bounded",
    ).x
    return circle.at(np.linspace(np.pi / 2, lean, ARC)), float(lean)


def _bending(lean: float, points: Array, circle: Circle) -> float:
    """Return the integral of |x''|^2 of the spline that leaves the circle at `lean`."""
    side = _spline(np.vstack([circle.at(np.array([lean])), points]), lean, None)
    bend = side(side.x, 2)
    start, end = bend[:-1], bend[1:]
    return float(np.diff(side.x) @ (start**2 + start * end + end**2).sum(axis=1))


def _spline(points: Array, lean: float, lean_end: float | None) -> CubicSpline[np.float64]:
    """Return the spline of given end directions; an end without one is natural."""
    along = np.append(0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)))
    start = np.array([np.cos(lean), np.sin(lean)])
    if lean_end is None:
        return CubicSpline(along, points, bc_type=((1, start), (2, np.zeros(2))))
    return CubicSpline(
        along, points, bc_type=((1, start), (1, np.array([np.cos(lean_end), np.sin(lean_end)])))
    )


def _graded(length: float, first: float) -> Vector:
    """Return the inner nodes of [0, length], their steps growing from `first`."""
    count = max(1, round(np.log1p(length / first * (GROWTH - 1)) / np.log(GROWTH)))
    nodes = np.cumsum(GROWTH ** np.arange(count))
    inner: Vector = length * nodes[:-1] / nodes[-1]
    return inner
