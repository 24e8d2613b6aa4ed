"""Both sides of a blade given by a formula, fitted by tensor-product B-splines on shared knots."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, TypeAlias

import numpy as np
from scipy.linalg import solve_triangular

from bladecad.arrays import Array, Vector
from bladecad.errors import GeometryError
from bladecad.splines import basis, clamped
from bladecad.surface.blade import SideName
from bladecad.surface.loft import DEGREE, ENDS, SIDES, curve_poles, gauss, halved
from bladecad.surface.patch import SplinePatch

Formula: TypeAlias = Callable[[SideName, Vector, Vector, int], Array]
"""Side, u, t and the highest order r to values and derivatives in t, (r + 1, len(u), len(t), 3)."""

SAFE: Final = 0.45  # of the tolerance for each of u and t
MOST: Final = (200, 600)  # spans in u and t
BETWEEN: Final = np.linspace(0.0, 1.0, 7)[1:-1]


def fitted(
    formula: Formula, u: Vector, t: Vector, *, tolerance: float, joined: tuple[bool, bool]
) -> tuple[SplinePatch, SplinePatch]:
    """Fit two bicubic patches whose distance from the formula, at equal (u,t), is measured.

    Parameters
    ----------
    formula : callable
    u, t : (m,) and (n,) float
        Breaks to begin with, from 0 to 1; spans where the fit strays are halved.
    tolerance : float
        mm
    joined : (bool, bool)
        Whether the sides have the same curve at the leading, and at the trailing edge.

    Raises
    ------
    GeometryError
        If 200 spans along u, or 600 along t, are not enough.

    Notes
    -----
    Least squares along t in every row of samples, value, tangent and curvature exact at both
    edges; then least squares along u, hub and tip exact. Both are linear and act on all rows
    alike, so tangents that agree across an edge in the formula agree in the patches.
    """
    while len(u) <= MOST[0] and len(t) <= MOST[1]:
        off_u, off_t = (np.max(a, axis=0) for a in zip(*(_off(formula, s, u, t) for s in SIDES),
                                                       strict=True))  # fmt: skip
        poor_u, poor_t = off_u > SAFE * tolerance, off_t > SAFE * tolerance
        if not poor_u.any() and not poor_t.any():
            return _patches(formula, u, t, joined)
        u, t = halved(u, poor_u), halved(t, poor_t)
    raise GeometryError(
        f"the fit is still {1e3 * max(off_u.max(), off_t.max()):.3g} um off with {len(u) - 1} x "
        f"{len(t) - 1} spans, {1e3 * tolerance:.3g} um are allowed; ask for a larger tolerance"
    )


def _off(formula: Formula, name: SideName, u: Vector, t: Vector) -> tuple[Vector, Vector]:
    """Largest distance from the formula in every span of u, and of t, each fitted by itself."""
    us, ts = _samples_u(u)[0], gauss(t, 5)[0]
    between_u, between_t = _between(u), _between(t)
    poles = _along_t(formula, name, us, t)
    found = np.einsum("jl,klx->kjx", basis(clamped(t, DEGREE), DEGREE, between_t), poles)
    exact = formula(name, us, between_t, 0)[0]
    off_t = np.linalg.norm(found - exact, axis=2).max(axis=0)
    rows = _along_u(formula(name, us, ts, 0)[0], u)
    found = np.einsum("ik,kjx->ijx", basis(clamped(u, DEGREE), DEGREE, between_u), rows)
    exact = formula(name, between_u, ts, 0)[0]
    off_u = np.linalg.norm(found - exact, axis=2).max(axis=1)
    return off_u.reshape(len(u) - 1, -1).max(axis=1), off_t.reshape(len(t) - 1, -1).max(axis=1)


def _patches(
    formula: Formula, u: Vector, t: Vector, joined: tuple[bool, bool]
) -> tuple[SplinePatch, SplinePatch]:
    us = _samples_u(u)[0]
    suction, pressure = (_along_u(_along_t(formula, s, us, t), u) for s in SIDES)
    for column, same in zip((0, -1), joined, strict=True):
        if same:
            pressure[:, column] = suction[:, column]
    knots = clamped(u, DEGREE), clamped(t, DEGREE)
    return (SplinePatch(suction, *knots, DEGREE, DEGREE),
            SplinePatch(pressure, *knots, DEGREE, DEGREE))  # fmt: skip


def _along_t(formula: Formula, name: SideName, u: Vector, t: Vector) -> Array:
    """Poles along t of the rows at u, (len(u), n, 3)."""
    samples, weights = gauss(t, 5)
    ends = formula(name, u, np.array([0.0, 1.0]), ENDS - 1)
    curves = formula(name, u, samples, 0)[0]
    return curve_poles(curves, np.moveaxis(ends, 2, 0), clamped(t, DEGREE), samples, weights)


def _along_u(rows: Array, u: Vector) -> Array:
    """Poles along u of what is sampled there, the first and last row exact, (m, n, 3)."""
    us, weights = _samples_u(u)
    N, w = basis(clamped(u, DEGREE), DEGREE, us), np.sqrt(weights)[:, None]
    Y = rows.reshape(len(us), -1)
    rest = Y - N[:, :1] * Y[0] - N[:, -1:] * Y[-1]
    Q, R = np.linalg.qr(w * N[:, 1:-1])
    inner = solve_triangular(R, Q.T @ (w * rest))
    return np.asarray(np.concatenate([Y[:1], inner, Y[-1:]])).reshape(-1, *rows.shape[1:])


def _samples_u(u: Vector) -> tuple[Vector, Vector]:
    samples, weights = gauss(u, 5)
    return np.array([0.0, *samples, 1.0]), np.array([0.0, *weights, 0.0])


def _between(breaks: Vector) -> Vector:
    return np.asarray(breaks[:-1, None] + np.diff(breaks)[:, None] * BETWEEN).ravel()
