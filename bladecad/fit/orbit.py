"""The state of a linear system along its flow, z(t) = exp(At) z0, as a basis in t."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import final

import numpy as np

from bladecad.arrays import Array, Vector, seal

REACH = 1.0  # norm of A times the distance between stops; half of it to the nearest
MOST_DOUBLINGS = 15
TERMS = 20  # (1/2)^20 / 20! is far below rounding


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

    @cached_property
    def stops(self) -> tuple[Vector, Array]:
        """Times close enough for a short series between them, and the states there.

        By doubling, with one exponential: exp(A 2h) = exp(A h)^2 takes one half to the other.
        """
        from scipy.linalg import expm  # only the paper's models need more than numpy

        norm = max(float(np.linalg.norm(self.A, 2)) / REACH, 1.0)
        doublings = int(min(np.ceil(np.log2(norm)), MOST_DOUBLINGS))
        E = step = expm(self.A / 2**doublings)
        states = self.z0[None]
        for _ in range(doublings):
            states = np.concatenate([states, states @ E.T])
            E = E @ E
        states = np.concatenate([states, states[-1:] @ step.T])
        return np.linspace(0.0, 1.0, len(states)), np.asarray(states)

    def __call__(self, t: Vector, order: int = 0) -> Array:
        """State or its derivative, A^r exp(At) z0, (k, d); infinite where it leaves the floats.

        From the nearest stop by Taylor's series, exp(Ah) z = sum (Ah)^j z / j!.
        """
        with np.errstate(over="ignore", invalid="ignore"):
            times, states = self.stops
            near = np.clip(np.rint(np.asarray(t) * (len(times) - 1)), 0, len(times) - 1).astype(int)
            h = (np.asarray(t) - times[near])[:, None]
            term = states[near] @ np.linalg.matrix_power(self.A, order).T
            total = term
            for j in range(1, TERMS):
                term = (term @ self.A.T) * (h / j)
                total = total + term
            return np.asarray(total)
