"""Where to put so many points on a line, and how far the spline through them then strays."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.interpolate import CubicSpline

from bladecad.arrays import Array, Points, Vector

GROWTH: Final = 0.25  # of the spacing, over the way: neighbouring gaps differ by a quarter
STRAIGHT: Final = 1e-4  # 1/mm^(3/4), that a straight line counts
ROUNDS: Final = 12
FINE: Final = 33  # samples of the spline in a gap


def spread(line: Points, t: Vector, gaps: int) -> Vector:
    """Choose parameters from a dense line so that a cubic spline follows it with even error.

    Half of the points go by arc length and half by curvature^(3/4), the fourth root of |x''''| on
    a circle, which the error of the spline follows (de Boor, A Practical Guide to Splines,
    ch. XII); gaps grow by a quarter from one to the next at most.

    Parameters
    ----------
    line : (k, 3) float, mm
        Dense, in order.
    t : (k,) float
        Parameter of its points, rising.
    gaps : int
        Between the points.

    Returns
    -------
    (gaps + 1,) float
        Parameters, the first and last those of the line.
    """
    ds = np.linalg.norm(np.diff(line, axis=0), axis=1)
    s = np.concatenate([[0.0], np.cumsum(ds)])
    rate = _curvature(line, ds) ** 0.75
    density = rate + max(float(_trapezoid(ds) @ rate / s[-1]), STRAIGHT)
    wanted = _trapezoid(ds) @ density / (gaps * density)
    for _ in range(ROUNDS):
        h = _grown(wanted, s)
        mass = np.concatenate([[0.0], np.cumsum(0.5 * (1 / h[1:] + 1 / h[:-1]) * ds)])
        wanted = wanted * mass[-1] / gaps
    found = np.interp(np.linspace(0.0, mass[-1], gaps + 1), mass, t)
    found[[0, -1]] = t[[0, -1]]
    return np.asarray(found)


def strayed(points: Points, middles: Points, *, closed: bool) -> float:
    """Largest distance of true points, one in every gap, from the cubic spline through `points`.

    Parameters
    ----------
    points : (n, 3) float, mm
    middles : (n - 1, 3) or, closed, (n, 3) float, mm
        Points of the line itself, one between each two.
    closed : bool
        The spline is periodic; else not-a-knot.
    """
    loop = np.concatenate([points, points[:1]]) if closed else points
    w = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(loop, axis=0), axis=1))])
    spline = CubicSpline(w, loop, bc_type="periodic" if closed else "not-a-knot")
    within = w[:-1, None] + np.diff(w)[:, None] * np.linspace(0.0, 1.0, FINE)
    X = spline(within)
    a, e = X[:, :-1], np.diff(X, axis=1)
    q = middles[:, None] - a
    along = np.clip(np.einsum("gfx,gfx->gf", q, e) / np.einsum("gfx,gfx->gf", e, e), 0.0, 1.0)
    return float(np.linalg.norm(q - along[:, :, None] * e, axis=2).min(axis=1).max())


def _curvature(line: Points, ds: Vector) -> Vector:
    """Turning of the tangent over the way, 1/mm, at every point of a dense line."""
    T = np.diff(line, axis=0) / ds[:, None]
    turn = np.linalg.norm(np.diff(T, axis=0), axis=1) / (0.5 * (ds[1:] + ds[:-1]))
    return np.concatenate([turn[:1], turn, turn[-1:]])


def _trapezoid(ds: Vector) -> Vector:
    """Weights of the trapezoidal rule."""
    return np.asarray(0.5 * (np.append(ds, 0.0) + np.append(0.0, ds)))


def _grown(wanted: Vector, s: Vector) -> Array:
    """The largest spacing below the wanted one that grows slowly enough either way."""
    h = np.minimum.accumulate(wanted - GROWTH * s) + GROWTH * s
    back = np.minimum.accumulate((h + GROWTH * s)[::-1])[::-1] - GROWTH * s
    return np.asarray(back)
