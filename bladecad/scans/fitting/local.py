"""Cubic B-splines by the four that live at each place, for sums over millions of points."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Vector, seal
from bladecad.splines import basis, clamped, not_a_knot

DEGREE: Final = 3
ORDER: Final = DEGREE + 1


@final
@dataclass(frozen=True, eq=False)
class Splines:
    """The cubic B-splines on a knot vector from 0 to 1, ends repeated; a `Basis` of a side."""

    knots: Vector

    def __post_init__(self) -> None:
        seal(self, knots=(None,))

    @staticmethod
    def on(breaks: Vector) -> Splines:
        """Return those with simple inner knots at the breaks."""
        return Splines(clamped(breaks, DEGREE))

    @staticmethod
    def through(nodes: Vector) -> Splines:
        """Return those of the C2 spline through nodes, four of them at least."""
        return Splines(not_a_knot(nodes)[0])

    @property
    def size(self) -> int:
        """Number of functions."""
        return len(self.knots) - ORDER

    @cached_property
    def one(self) -> Vector:
        """(n,) float: the coefficients of the constant 1."""
        return np.ones(self.size)

    def __call__(self, t: Vector, order: int = 0) -> Array:
        """Value or derivative of all of them, (len(t), size)."""
        return basis(self.knots, DEGREE, np.asarray(t, dtype=np.float64), order)

    def four(self, x: Vector) -> tuple[NDArray[np.intp], Array]:
        """Number of the first function that lives at each place, and the values of the four.

        Returns
        -------
        (k,) int and (k, 4) float
            The triangle of Cox and de Boor, for all places at once.
        """
        k = self.knots
        span = np.clip(np.searchsorted(k, x, side="right") - 1, DEGREE, self.size - 1)
        values = np.zeros((len(x), ORDER))
        values[:, 0] = 1.0
        for p in range(1, ORDER):
            saved = np.zeros(len(x))
            for r in range(p):
                right, left = k[span + r + 1] - x, x - k[span + 1 - p + r]
                share = values[:, r] / (right + left)
                values[:, r] = saved + right * share
                saved = left * share
            values[:, p] = saved
        return span - DEGREE, values
