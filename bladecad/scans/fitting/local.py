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

    def four(self, x: Vector) -> tuple[NDArray[np.int64], Array]:
        """Number of the first function that lives at each place, and the values of the four.

        Returns
        -------
        (k,) int and (k, 4) float
        """
        from bladecad.scans.fitting.kernels import four

        first, values = np.empty(len(x), np.int64), np.empty((len(x), ORDER))
        four(self.knots, np.ascontiguousarray(x), first, values)
        return first, values
