"""x' = A x + a fitted on the trajectory itself: the best any three states can do.

Whatever A and a are, the curve is a constant and three modes, one real and a pair,

    x(t) = c0 + c1 exp(m t) cosh(w t) + c2 exp(m t) sinh(w t)/w + c3 exp(r t),     w^2 = s,

with s of either sign. Given (m, s, r), the rest is linear: variable projection over three numbers.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from bladecad.arrays import Array, Lines, Vector
from bladecad.fit.samples import Samples
from bladecad.replay.curves import Curves
from bladecad.replay.subject import JUDGED, Stretch

Start = tuple[float, float, float]
STARTS: Final[tuple[Start, ...]] = ((0.0, -9.0, -1.0), (0.0, 900.0, 1.0))
MOST: Final = np.array([300.0, 9e4, 300.0])
UNIT: Final = np.array([10.0, 100.0, 10.0])  # sizes in which m, s and r are alike
ROUNDS, NUDGE = 20, 1e-4
ENOUGH, HOPELESS = 1e-5, 1e6  # relative gain, and damping, at which a line is settled
SEARCHED: Final = 2  # every second sample is enough for the rates
RIDGE: Final = 1e-9  # of a column: keeps modes that have become equal apart
FLAT: Final = 1e-8  # s t^2 below which sinh(w t)/w is its series


def on_trajectory(stretch: Stretch, starts: Sequence[Start] = STARTS) -> Curves:
    """Fit every line to its densified self, best of some starts."""
    dense = followed(stretch.fitted, stretch.judged.t, starts)
    return Curves(dense[:, ::JUDGED], dense)


def followed(samples: Samples, at: Vector, starts: Sequence[Start] = STARTS) -> Lines:
    """Fit every line to its samples and evaluate it elsewhere, (m, len(at), 3), mm."""
    t, Y = samples.t, samples.points
    trials = [
        _search(np.tile(start, (len(Y), 1)), t[::SEARCHED], Y[:, ::SEARCHED]) for start in starts
    ]
    misfits = np.array([_misfit(theta, t, Y)[0] for theta in trials])
    theta = np.array(trials)[misfits.argmin(axis=0), np.arange(len(Y))]
    C = _misfit(theta, t, Y)[2]
    return np.asarray(modes(theta, at) @ C)


def modes(theta: Array, t: Vector) -> Array:
    """The constant and the three modes of every line, (m, len(t), 4), none above about 1."""
    m, s, r = (v[:, None] for v in theta.T)
    w = np.sqrt(np.abs(s) + 0j) * np.where(s < 0, 1j, 1.0)
    grown = np.exp(-np.maximum(m + w.real, 0.0) + m * t)
    even = np.cosh(w * t).real * grown
    odd = np.where(np.abs(s) * t**2 < FLAT, t * grown, _sinhc(w, t) * grown)
    return np.stack([np.ones_like(even), even, odd, np.exp(r * t - np.maximum(r, 0.0))], axis=-1)


def _sinhc(w: Array, t: Vector) -> Array:
    return np.asarray((np.sinh(w * t) / np.where(w == 0, 1.0, w)).real)


def _search(theta: Array, t: Vector, Y: Lines) -> Array:
    """Levenberg-Marquardt on all lines at once, each with its own damping."""
    damping = np.full(len(theta), 1e-2)
    before, residual, _ = _misfit(theta, t, Y)
    settled = np.zeros(len(theta), bool)
    for _ in range(ROUNDS):
        step = _step(theta, residual, damping, t, Y)
        trial = np.clip(theta + step, -MOST, MOST)
        after, moved, _ = _misfit(trial, t, Y)
        better = after < before
        theta = np.where(better[:, None], trial, theta)
        residual = np.where(better[:, None, None], moved, residual)
        settled |= (np.abs(before - after) < ENOUGH * before) | (damping > HOPELESS)
        before = np.where(better, after, before)
        damping = np.clip(damping * np.where(better, 0.3, 4.0), 1e-9, 1e9)
        if settled.all():
            break
    return theta


def _step(theta: Array, residual: Lines, damping: Vector, t: Vector, Y: Lines) -> Array:
    nudges = NUDGE * np.diag(UNIT)
    J = np.stack([(_misfit(theta + d, t, Y)[1] - residual) / NUDGE for d in nudges], axis=-1)
    H = np.einsum("mkxi,mkxj->mij", J, J)
    g = np.einsum("mkxi,mkx->mi", J, residual)
    D = np.einsum("mii->mi", H) * damping[:, None] + 1e-12
    H = H + np.einsum("mi,ij->mij", D, np.eye(3))
    return np.asarray(-np.linalg.solve(H, g[..., None])[..., 0] * UNIT)


def _misfit(theta: Array, t: Vector, Y: Lines) -> tuple[Vector, Lines, Array]:
    """Sum of squares, residual and coefficients of every line, by QR."""
    Phi = modes(theta, t)
    size = np.linalg.norm(Phi, axis=1, keepdims=True)
    held = np.broadcast_to(RIDGE * np.eye(4), (len(Y), 4, 4))
    Q, R = np.linalg.qr(np.concatenate([Phi / size, held], axis=1))
    C = np.linalg.solve(R, np.swapaxes(Q[:, : len(t)], 1, 2) @ Y) / np.swapaxes(size, 1, 2)
    residual = Phi @ C - Y
    return np.einsum("mkx,mkx->m", residual, residual), residual, np.asarray(C)
