"""Places spread over both sides of a blade: where they are, and how the surface bends there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from bladecad.arrays import Array, Points, Vector, seal
from bladecad.surface.blade import BladeSurface, normals, principal_curvatures
from bladecad.surface.loft import SIDES, graded
from bladecad.tolerance import EDGE_ZONE


@final
@dataclass(frozen=True, eq=False)
class Places:
    """A grid on both sides, the suction side first, in rows of equal u.

    u, t     : (m,) and (n,) float
    X, n     : (2, m, n, 3) float; points, mm, and unit normals out of the metal
    k1, k2   : (2, m, n) float, 1/mm; principal curvatures, larger first, positive where convex
    """

    u: Vector
    t: Vector
    X: Array
    n: Array
    k1: Array
    k2: Array

    def __post_init__(self) -> None:
        shape = (2, len(self.u), len(self.t))
        seal(self, u=(None,), t=(None,), X=(*shape, 3), n=(*shape, 3), k1=shape, k2=shape)

    @property
    def points(self) -> Points:
        """All of them, (k, 3)."""
        return self.X.reshape(-1, 3)

    @property
    def directions(self) -> Points:
        """Their normals, (k, 3)."""
        return self.n.reshape(-1, 3)

    def named(self, index: int) -> str:
        """Say where the place of that number, of all, lies."""
        side, i, j = np.unravel_index(index, self.k1.shape)
        u, t = self.u[i], self.t[j]
        where = "leading edge" if t < EDGE_ZONE else "trailing edge" if t > 1.0 - EDGE_ZONE else ""
        return f"{where or SIDES[side] + ' side'} at u = {u:.3f}, t = {t:.4f}"


def places(surface: BladeSurface, rows: int = 61, columns: int = 401) -> Places:
    """Spread places over a blade, ever closer towards both edges; sections are rows, too."""
    u = np.union1d(np.linspace(0.0, 1.0, rows), surface.span)
    u, t = u[np.diff(u, prepend=-1.0) > 1e-9], graded(columns)
    k = np.array([principal_curvatures(surface, s, u, t) for s in SIDES])
    X = np.array([surface(s, u, t) for s in SIDES])
    n = np.array([normals(surface, s, u, t) for s in SIDES])
    return Places(u, t, X, n, k[:, 0], k[:, 1])
