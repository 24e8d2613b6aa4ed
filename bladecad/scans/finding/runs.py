"""Many small least-squares problems at once, their rows one after the other."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Vector

RIDGE = 1e-9  # of the mean of the diagonal: a problem with too few places is solved, too


class Runs(NamedTuple):
    """Rows of an array that belong together, run by run.

    sizes : (m,) int, rows of each, one at least
    """

    sizes: NDArray[np.int64]

    def parts(self, rows: Array) -> list[Array]:
        """Return the rows of each run."""
        ends = np.cumsum(self.sizes)
        return [rows[end - k : end] for end, k in zip(ends, self.sizes, strict=True)]

    def each(self, values: Array) -> Array:
        """Return the value of its run for every row."""
        return np.repeat(values, self.sizes, axis=0)

    def mean(self, rows: Array) -> Array:
        """Mean of each run, (m, ...)."""
        sums = np.add.reduceat(rows, np.cumsum(self.sizes) - self.sizes, axis=0)
        return np.asarray((sums.T / self.sizes).T)

    def products(self, A: Array) -> Array:
        """A^T A of each run, (m, n, n)."""
        return np.stack([part.T @ part for part in self.parts(A)])

    def solved(self, A: Array, y: Vector) -> Array:
        """Least squares of each run, (m, n)."""
        both = self.products(np.column_stack([A, y]))
        G, r = both[:, :-1, :-1], both[:, :-1, -1:]
        ridge = RIDGE * np.trace(G, axis1=1, axis2=2) / G.shape[1]
        G = G + ridge[:, None, None] * np.eye(G.shape[1])
        return np.asarray(np.linalg.solve(G, r)[..., 0])

    def times(self, A: Array, c: Array) -> Vector:
        """Return A c, with the c of its run for every row, (k,)."""
        return np.asarray(np.einsum("kn,kn->k", A, self.each(c)))
