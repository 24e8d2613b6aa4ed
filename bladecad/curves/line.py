"""A measured line, made dense: the C2 cubic spline through its points, by its own arc length."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import final

import numpy as np
from scipy.interpolate import CubicSpline

from bladecad.arrays import Array, Points, Vector, seal

STILL = 1e-8  # of the length; after a step as short, what Newton's method leaves is rounding
GAUSS = np.polynomial.legendre.leggauss(8)  # |x'| of a cubic: smooth between points


@final
@dataclass(frozen=True, eq=False)
class Line:
    """The cubic spline through measured points, periodic or open.

    points : (n, d) float, mm; in order, the first not repeated at the end, d = 2 or 3
    closed : True joins the last point to the first with continuous curvature

    The spline parameter is the accumulated distance between the points (eq. 8); places on the
    line are given by true arc length s, 0 at the first point.
    """

    points: Points
    closed: bool

    def __post_init__(self) -> None:
        seal(self, points=(None, np.shape(self.points)[1]))

    @cached_property
    def spline(self) -> CubicSpline[np.float64]:
        """The spline x(w), w the accumulated distance between points."""
        loop = np.concatenate([self.points, self.points[:1]]) if self.closed else self.points
        w = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(loop, axis=0), axis=1))])
        if self.closed:
            return CubicSpline(w, loop, bc_type="periodic")
        return CubicSpline(w, loop, bc_type="not-a-knot")

    @cached_property
    def stations(self) -> Vector:
        """(n,) or, closed, (n + 1,) float: arc length at the points, mm."""
        w = self.spline.x
        return np.concatenate([[0.0], np.cumsum(self._run(w[:-1], w[1:]))])

    @property
    def length(self) -> float:
        """Arc length of the whole line, mm."""
        return float(self.stations[-1])

    def __call__(self, s: Vector, order: int = 0) -> Array:
        """Point (order 0), unit tangent (1) or curvature vector (2) at arc length `s`, (k, d)."""
        w = self._parameter(np.asarray(s, dtype=np.float64))
        if order == 0:
            return np.asarray(self.spline(w))
        x1 = self.spline(w, 1)
        speed = np.linalg.norm(x1, axis=-1, keepdims=True)
        T = x1 / speed
        if order == 1:
            return np.asarray(T)
        x2 = self.spline(w, 2)
        return np.asarray((x2 - T * np.einsum("kd,kd->k", x2, T)[:, None]) / speed**2)

    def densified(self, samples: int) -> Vector:
        """Arc lengths of `samples` equal steps in every gap between points, first point first."""
        ends = self.stations
        steps = np.arange(samples) / samples
        dense = (ends[:-1, None] + np.diff(ends)[:, None] * steps).ravel()
        return dense if self.closed else np.append(dense, ends[-1])

    def _run(self, w0: Vector, w1: Vector) -> Vector:
        """Arc length from w0 to w1, both in one gap, by Gauss-Legendre quadrature."""
        nodes, weights = GAUSS
        half = 0.5 * (w1 - w0)
        x1 = self.spline(w0[:, None] + half[:, None] * (nodes + 1.0), 1)
        return np.asarray(half * (np.linalg.norm(x1, axis=-1) @ weights))

    def _parameter(self, s: Vector) -> Vector:
        """The spline parameter w at arc length s, by Newton's method inside its gap."""
        ends, knots = self.stations, self.spline.x
        s = np.mod(s, self.length) if self.closed else np.clip(s, 0.0, self.length)
        gap = np.clip(np.searchsorted(ends, s, side="right") - 1, 0, len(ends) - 2)
        w0, w1 = knots[gap], knots[gap + 1]
        w = w0 + (w1 - w0) * (s - ends[gap]) / (ends[gap + 1] - ends[gap])
        for _ in range(4):
            speed = np.linalg.norm(self.spline(w, 1), axis=-1)
            step = (self._run(w0, w) - (s - ends[gap])) / speed
            w = np.clip(w - step, w0, w1)
            if np.abs(step).max(initial=0.0) < STILL * self.length:
                break
        return np.asarray(w)
