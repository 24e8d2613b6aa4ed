"""The nonlinear step the paper suggests: a quadratic right-hand side, matched like the linear one.

    y' = a + A y + sum_ij b_ij y_i y_j,      y = (x - centre) / size,

ten coefficients a coordinate, found from the same differences at the same midpoints, and followed
from the first point by Runge-Kutta: there is no exponential any more.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from bladecad.arrays import Array, Lines, Vector
from bladecad.fit.differences import regress
from bladecad.fit.steps import arc_length_steps
from bladecad.replay.curves import Curves
from bladecad.replay.matched import model_times
from bladecad.replay.subject import JUDGED, Stretch

PAIRS: Final = np.triu_indices(3)


def quadratic(stretch: Stretch) -> Curves:
    """Match the differences of every line, and run all lines at once."""
    centre = stretch.points.mean(axis=1, keepdims=True)
    size = np.sqrt(np.mean((stretch.points - centre) ** 2, axis=(1, 2), keepdims=True))
    y = (stretch.points - centre) / size
    M = np.array([_matched(line) for line in y])
    t = model_times(stretch, "arc-length")
    dense = centre + size * _runge_kutta(M, y[:, 0], t)
    return Curves(dense[:, ::JUDGED], dense)


def monomials(y: Array) -> Array:
    """1, y_i and y_i y_j, (..., 10)."""
    i, j = PAIRS
    return np.concatenate([np.ones((*y.shape[:-1], 1)), y, y[..., i] * y[..., j]], axis=-1)


def _matched(y: Array) -> Array:
    steps = arc_length_steps(y)
    middle = (y[1:] + y[:-1]) / 2
    M, _, _ = regress(monomials(middle), np.diff(y, axis=0) / steps[:, None], "lstsq")
    return M


def _runge_kutta(M: Array, start: Array, t: Array) -> Lines:
    """Follow all lines, (m, 3) at the start, through their own times, (m, K)."""
    y, states = start, [start]
    with np.errstate(over="ignore", invalid="ignore"):
        for h in np.diff(t, axis=1).T:
            y = _step(M, y, h[:, None])
            states.append(y)
    return np.stack(states, axis=1)


def _step(M: Array, y: Array, h: Vector) -> Array:
    k1 = _field(M, y)
    k2 = _field(M, y + h / 2 * k1)
    k3 = _field(M, y + h / 2 * k2)
    k4 = _field(M, y + h * k3)
    return y + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)


def _field(M: Array, y: Array) -> Array:
    return np.asarray(np.einsum("mxj,mj->mx", M, monomials(y)))
