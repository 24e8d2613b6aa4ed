"""One side of a blade as flows, one a section: a basis in t and coefficients for it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, final

import numpy as np

from bladecad.arrays import Array, Points, Vector, seal


class Basis(Protocol):
    """Scalar functions of t: the state z(t) of a linear system, x(t) = C z(t)."""

    @property
    def size(self) -> int:
        """Number of functions."""

    def __call__(self, t: Vector, order: int = 0) -> Array:
        """Value or derivative at t, (len(t), size)."""


@final
@dataclass(frozen=True, eq=False)
class SideFit:
    """One side as x_i(t) = C_i z_i(t) at every section i.

    bases        : one basis that all sections share, or one a section
    coefficients : (m, n, 3) float, mm; C_i transposed
    """

    bases: tuple[Basis, ...]
    coefficients: Array

    def __post_init__(self) -> None:
        seal(self, coefficients=(None, self.bases[0].size, 3))

    def __call__(self, t: Vector, order: int = 0) -> Array:
        """Points, or derivatives, of every section at the same t, (m, len(t), 3)."""
        if len(self.bases) == 1:
            return np.asarray(self.bases[0](t, order) @ self.coefficients)  # tn,mnx->mtx
        pairs = zip(self.bases, self.coefficients, strict=True)
        return np.array([basis(t, order) @ C for basis, C in pairs])

    def section(self, i: int, t: Vector) -> Points:
        """Points of one section, (len(t), 3)."""
        basis = self.bases[i if len(self.bases) > 1 else 0]
        return np.asarray(basis(t) @ self.coefficients[i])
