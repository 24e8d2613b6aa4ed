"""A tensor-product B-spline patch as plain arrays: what the surface hands to the CAD kernel."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from bladecad.arrays import Array, Vector, seal
from bladecad.splines import basis


@final
@dataclass(frozen=True, eq=False)
class SplinePatch:
    """One four-sided face, S(u,t) = sum_kl N_k(u) M_l(t) poles[k,l].

    poles            : (nu, nt, 3) float, mm; row 0 at the hub, column 0 at the leading edge
    knots_u, knots_t : full knot vectors, ends repeated degree + 1 times, both from 0 to 1
    degree_u, degree_t : int
    """

    poles: Array
    knots_u: Vector
    knots_t: Vector
    degree_u: int
    degree_t: int

    def __post_init__(self) -> None:
        nu, nt, _ = np.shape(self.poles)
        seal(
            self,
            poles=(nu, nt, 3),
            knots_u=(nu + self.degree_u + 1,),
            knots_t=(nt + self.degree_t + 1,),
        )

    def __call__(self, u: Vector, t: Vector, du: int = 0, dt: int = 0) -> Array:
        """Evaluate the patch or a partial derivative on the grid u x t, (len(u), len(t), 3)."""
        N = basis(self.knots_u, self.degree_u, u, du)
        M = basis(self.knots_t, self.degree_t, t, dt)
        return np.asarray(np.einsum("ik,jl,klx->ijx", N, M, self.poles, optimize=True))
