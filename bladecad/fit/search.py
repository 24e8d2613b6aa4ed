"""The search for rates: two starts, downhill from each, the better one."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from bladecad.arrays import Array, Vector
from bladecad.fit.best_linear import best_linear
from bladecad.fit.growth import grown, shrunk
from bladecad.fit.projection import LOG_A, project
from bladecad.fit.spectrum import Spectrum

SPREAD_LOG_A: Final = (LOG_A[0], float(np.log(1500.0)))
SPREAD_K: Final = 0.4
COARSE: Final = 2  # every second sample tells one minimum from another
PROMISING: Final = 10  # steps after which a second start is given up where it is
BEHIND: Final = 2.0  # times the sum of squares of the first


def find_rates(
    le: int, te: int, degree: int, t: Vector, Y: Array, near: Spectrum | None = None
) -> Spectrum:
    """Find the rates with which a side is followed best.

    Parameters
    ----------
    le, te : int
        Pairs of modes at either edge.
    degree : int
        Of the core.
    t : (N,) float
    Y : (N, d) float
        All sections side by side.
    near : Spectrum, optional
        Found with at least as many pairs: the first start is what is left of it, instead of being
        grown.

    Notes
    -----
    The sum of squares has many minima in the rates. Over both sides of 15 blades and three orders,
    the rms reached was above the best one known by 8 % in the geometric mean and 2.4 times at most
    from evenly spread rates, 4 % and 1.33 times from rates grown pair by pair, 3 % and 1.14 times
    by both starts, the second given up where it falls behind.
    """
    thin = np.append(np.arange(len(t) - 1)[::COARSE], len(t) - 1)
    few, Y_few = t[thin], Y[thin]

    def misfit(spectrum: Spectrum) -> float:
        return best_linear(spectrum, few, Y_few).rss

    start = near and shrunk(near, le, te, degree, few, Y_few)
    (best,) = project(start or grown(le, te, degree, few, Y_few), few, [Y_few])
    (other,) = project(spread(le, te, degree), few, [Y_few], steps=PROMISING)
    if misfit(other) < BEHIND * misfit(best):
        best = min(best, *project(other, few, [Y_few]), key=misfit)
    return project(best, t, [Y])[0]


def spread(le: int, te: int, degree: int, knots: Sequence[float] = ()) -> Spectrum:
    """Spread the rates evenly over the range in which they are found."""
    return Spectrum(degree, _spread(le), _spread(te), np.array(knots))


def _spread(pairs: int) -> Array:
    low, high = SPREAD_LOG_A
    places = (np.arange(pairs) + 0.5) / max(pairs, 1)
    return np.column_stack([np.exp(low + (high - low) * places), np.full(pairs, SPREAD_K)])
