"""The state of a linear system along its flow, z(t) = exp(At) z0, as a basis in t."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from bladecad.arrays import Array, Vector, seal


@final
@dataclass(frozen=True, eq=False)
class Orbit:
    """z(t) = exp(A t) z0: what a flow found by matching derivatives runs through.

    A  : (d, d) float
    z0 : (d,) float
    """

    A: Array
    z0: Vector

    def __post_init__(self) -> None:
        d = np.size(self.z0)
        seal(self, A=(d, d), z0=(d,))

    @property
    def size(self) -> int:
        """Number d of states."""
        return len(self.z0)

    def __call__(self, t: Vector, order: int = 0) -> Array:
        """State or its derivative, A^r exp(At) z0, (k, d); infinite where it leaves the floats."""
        from bladecad.fit.flow import propagator  # scipy: only the paper's models need it

        with np.errstate(over="ignore", invalid="ignore"):
            start = np.linalg.matrix_power(self.A, order) @ self.z0
            return np.asarray(propagator(self.A, np.asarray(t)) @ start)
