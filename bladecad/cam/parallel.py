"""The parallel surface O(u,t) = S + d n in closed form, and its derivatives along t."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import final

import numpy as np

from bladecad.arrays import Array, Vector
from bladecad.surface.blade import BladeSurface, SideName, outward
from bladecad.surface.loft import SIDES


@final
@dataclass(frozen=True, eq=False)
class Parallel:
    """All points at a distance from a blade along its normals.

    surface  : BladeSurface
    distance : mm, positive out of the metal
    """

    surface: BladeSurface
    distance: float

    def __call__(self, name: SideName, u: Vector, t: Vector) -> Array:
        """O on the grid u x t, (len(u), len(t), 3), mm."""
        return np.asarray(self.derivatives(name, u, t, 0)[0])

    def derivatives(self, name: SideName, u: Vector, t: Vector, most: int) -> Array:
        """O and its derivatives along t up to an order of at most 2, (most + 1, m, n, 3).

        N = S_u x S_t by Leibniz' rule, N' = S_ut x S_t + S_u x S_tt, and so on.
        """

        def D(du: int, dt: int) -> Array:
            return self.surface(name, u, t, du, dt)

        Su, St = [D(1, r) for r in range(most + 1)], [D(0, r + 1) for r in range(most + 1)]
        N = [np.cross(Su[0], St[0])]
        if most > 0:
            N.append(np.cross(Su[1], St[0]) + np.cross(Su[0], St[1]))
        if most > 1:
            N.append(np.cross(Su[2], St[0]) + 2 * np.cross(Su[1], St[1]) + np.cross(Su[0], St[2]))
        away = self.distance * self._outward[name] * unit_derivatives(np.array(N))
        return np.asarray(np.array([D(0, 0), *St[:most]]) + away)

    @cached_property
    def _outward(self) -> dict[SideName, float]:
        return {name: outward(self.surface, name) for name in SIDES}


def unit_derivatives(N: Array) -> Array:
    """Derivatives of n = N/|N| from those of N, (r, ..., 3) with r up to 3.

    From N = q n with q' = n . N' and q'' = n' . N' + n . N''.
    """
    q = np.linalg.norm(N[0], axis=-1, keepdims=True)
    n = [N[0] / q]
    if len(N) > 1:
        q1 = _dot(n[0], N[1])
        n.append((N[1] - q1 * n[0]) / q)
    if len(N) > 2:
        q2 = _dot(n[1], N[1]) + _dot(n[0], N[2])
        n.append((N[2] - 2.0 * q1 * n[1] - q2 * n[0]) / q)
    return np.array(n)


def _dot(a: Array, b: Array) -> Array:
    return np.asarray(np.einsum("...x,...x->...", a, b)[..., None])
