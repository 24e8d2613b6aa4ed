"""The linear half of variable projection: coefficients for given rates, and how the rates pull."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from scipy.linalg import qr, solve_triangular

from bladecad.arrays import Array, Vector
from bladecad.fit.spectrum import Spectrum, decay

RIDGE = 1e-11  # pivots below this share of the first: columns the data cannot tell apart
SERIES = 1e-4  # |k| below which d/dk of a mode is taken from its series


class BestLinear(NamedTuple):
    """The best coefficients for one spectrum, and what the next step needs."""

    spectrum: Spectrum
    C: Array
    residual: Array
    rss: float
    Q: Array


def best_linear(spectrum: Spectrum, t: Vector, Y: Array) -> BestLinear:
    """Solve min_C |Phi C - Y|^2 by QR with pivoting; dependent columns get zero."""
    Phi = spectrum(t)
    Q, R, order = qr(Phi, mode="economic", pivoting=True)
    d = np.abs(np.diag(R))
    rank = int(np.sum(d > RIDGE * d[0]))
    Q = np.asarray(Q[:, :rank], dtype=np.float64)
    QY = Q.T @ Y
    C = np.zeros((Phi.shape[1], Y.shape[1]))
    C[order[:rank]] = solve_triangular(R[:rank, :rank], QY)
    residual = np.asarray(Y - Q @ QY)
    return BestLinear(spectrum, C, residual, float(np.vdot(residual, residual)), np.array(Q))


def normal_equations(best: BestLinear, t: Vector) -> tuple[Array, Vector]:
    """J^T J and -J^T r for (log a, k) of every pair, with Kaufman's Jacobian.

    J_theta = -(1 - Q Q^T) (dPhi/dtheta) C: each theta moves two columns of Phi only, so J^T J is
    (D^T D) * (C C^T) summed over 2 x 2 blocks, D = (1 - Q Q^T) dPhi.
    """
    spectrum, C, residual, _, Q = best
    dPhi = np.concatenate([d for tau, k in _modes(spectrum, t) for d in _rates(tau, k)], axis=1)
    first = spectrum.size - dPhi.shape[1] // 2
    pairs = np.arange(first, spectrum.size).reshape(-1, 2)
    C = C[np.repeat(pairs, 2, axis=0).ravel()]
    g = np.einsum("jd,jd->j", dPhi.T @ residual, C).reshape(-1, 2).sum(axis=1)
    D = dPhi - Q @ (Q.T @ dPhi)
    m = len(g)
    H = ((D.T @ D) * (C @ C.T)).reshape(m, 2, m, 2).sum(axis=(1, 3))
    return np.asarray(H), np.asarray(g)


def _modes(spectrum: Spectrum, t: Vector) -> Iterator[tuple[Vector, float]]:
    for a, k in spectrum.le:
        yield a * t, k
    for a, k in spectrum.te:
        yield a * (1.0 - t), k


def _rates(tau: Vector, k: float) -> tuple[Array, Array]:
    """Derivatives of a pair of modes by log a and by k, each (N, 2)."""
    y1, y2 = decay(tau, k)
    by_log_a = np.column_stack([tau * (-y1 - k * y2), tau * (y1 - y2)])
    series = -(tau**3) * np.exp(-tau) * (1.0 / 6.0 - k * tau**2 / 60.0)
    exact = (tau * y1 - y2) / (2.0 * k if abs(k) >= SERIES else 1.0)
    by_k = np.column_stack([-0.5 * tau * y2, exact if abs(k) >= SERIES else series])
    return by_log_a, by_k
