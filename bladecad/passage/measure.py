"""How far the triangles of a passage are from the blade and the walls they stand for."""

from __future__ import annotations

import numpy as np

from bladecad.arrays import Array, Points, Vector
from bladecad.passage.cylinder import to_cylinder
from bladecad.passage.trim import Trimmed, WallName
from bladecad.surface.blade import SideName
from bladecad.surface.ruled import Triangles


def away_from_wall(blade: Trimmed, name: WallName, X: Points, k: Triangles, gap: float) -> float:
    """Largest distance of edge and triangle middles from a wall (less a gap), mm."""
    zr = to_cylinder(_middles(X, k), blade.axis)[:, :2]
    return float(np.abs(blade.wall(name).height(zr)[0] - gap).max())


def away_from_side(
    blade: Trimmed, side: SideName, X: Points, k: Triangles, places: tuple[Vector, Vector]
) -> float:
    """Largest distance along the normal of edge and triangle middles from a side, mm.

    places : v and t of every vertex
    """
    v, t = (_middles(p[:, None], k)[:, 0] for p in places)
    distinct, which = np.unique(t, return_inverse=True)
    low, high = (end[which] for end in blade.ends(side, distinct))
    u = (1.0 - v) * low + v * high
    S, U, T = (blade.surface.at(side, u, t, *d) for d in ((0, 0), (1, 0), (0, 1)))
    n = np.cross(U, T)
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    return float(np.abs(np.einsum("kx,kx->k", _middles(X, k) - S, n)).max())


def _middles(X: Array, k: Triangles) -> Array:
    """Middles of the three edges, then of the triangles, (4 k, ...)."""
    a, b, c = np.moveaxis(X[k], 1, 0)
    return np.concatenate([0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a), (a + b + c) / 3.0])
