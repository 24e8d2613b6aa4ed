"""The volume inside a blade by quadrature alone, a witness that never met the CAD kernel."""

from __future__ import annotations

import numpy as np

from bladecad.arrays import Vector
from bladecad.surface.patch import SplinePatch

POINTS = 6  # more than exact for bicubic patches: the integrand has degree 8 in u and in t
LINE = np.array([0.0, 0.0, 1.0, 1.0])
RIMS = (("hub", 0, 0, 1.0), ("tip", 0, -1, -1.0), ("le", 1, 0, 1.0), ("te", 1, -1, -1.0))


def volume(suction: SplinePatch, pressure: SplinePatch) -> float:
    """Volume between two patches, closed by ruled faces at hub, tip and blunt edges, mm^3.

    Divergence theorem, V = 1/3 |integral of x . (x_u x x_t)| over the closed surface, by
    Gauss-Legendre quadrature in every knot span; exact but for rounding. A plane through the same
    outline has the same flux as the ruled face.
    """
    origin = 0.5 * (suction.poles.mean(axis=(0, 1)) + pressure.poles.mean(axis=(0, 1)))
    rims = sum(sign * _flux(ruled(suction, pressure, a, e), origin) for _, a, e, sign in RIMS)
    return abs(_flux(pressure, origin) - _flux(suction, origin) + rims)


def ruled(suction: SplinePatch, pressure: SplinePatch, axis: int, end: int) -> SplinePatch:
    """Rule a face between the same border of both sides: axis 0 hub, tip; axis 1 LE, TE."""
    rows = [np.take(side.poles, end, axis=axis) for side in (suction, pressure)]
    if axis == 0:
        return SplinePatch(np.stack(rows, 0), LINE, suction.knots_t, 1, suction.degree_t)
    return SplinePatch(np.stack(rows, 1), suction.knots_u, LINE, suction.degree_u, 1)


def _flux(patch: SplinePatch, origin: Vector) -> float:
    """Integral of (X - origin) . (X_u x X_t) / 3 over the patch."""
    (u, wu), (t, wt) = _gauss(patch.knots_u), _gauss(patch.knots_t)
    cross = np.cross(patch(u, t, 1, 0), patch(u, t, 0, 1))
    return float(np.einsum("ijx,ijx,i,j->", patch(u, t) - origin, cross, wu, wt)) / 3.0


def _gauss(knots: Vector) -> tuple[Vector, Vector]:
    nodes, weights = np.polynomial.legendre.leggauss(POINTS)
    breaks = np.unique(knots)
    half = 0.5 * np.diff(breaks)[:, None]
    return (breaks[:-1, None] + half * (1.0 + nodes)).ravel(), (half * weights).ravel()
