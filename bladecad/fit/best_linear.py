"""The linear half of variable projection: coefficients for given rates, and how the rates pull."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dgeqrf, dorgqr, dtrtrs

from bladecad.arrays import Array, Vector
from bladecad.fit.spectrum import Spectrum

RIDGE = 1e-8  # a coefficient counts as little as a misfit of this share of it
SERIES = 1e-4  # |k| below which d/dk of a mode is taken from its series
BLOCK = 64  # columns that LAPACK takes at once, at most


class BestLinear(NamedTuple):
    """The best coefficients for one spectrum, and what the next step needs.

    residual : (N + n, d) float; below the N of the samples the n of the ridge
    Q        : (N + n, n) float, orthonormal columns
    Phi      : (N, n) float
    """

    spectrum: Spectrum
    C: Array
    residual: Array
    rss: float
    Q: Array
    Phi: Array


def best_linear(spectrum: Spectrum, t: Vector, Y: Array) -> BestLinear:
    """Solve min_C |Phi C - Y|^2 + RIDGE^2 |C|^2, by QR.

    Without the second term the sum of squares jumps wherever rates come close to each other, or a
    slow mode to a polynomial of the core, and the search would favour differences of huge modes.
    """
    Phi = spectrum(t)
    below = np.zeros((Phi.shape[1], Y.shape[1]))
    Q, R = _qr(np.concatenate([Phi, RIDGE * np.eye(len(below))]))
    QY = Q[: len(t)].T @ Y
    residual = np.asarray(np.concatenate([Y, below]) - Q @ QY)
    rss = float(np.vdot(residual, residual))
    return BestLinear(spectrum, np.asarray(dtrtrs(R, QY)[0]), residual, rss, Q, Phi)


def _qr(A: Array) -> tuple[Array, Array]:
    """Q and, in its upper triangle, R; `scipy.linalg.qr` without what it asks and checks."""
    n = A.shape[1]
    R, tau, _, _ = dgeqrf(A, lwork=BLOCK * n)
    return np.asarray(dorgqr(R, tau, lwork=BLOCK * n)[0]), np.asarray(R[:n])


def normal_equations(best: BestLinear, t: Vector) -> tuple[Array, Vector]:
    """J^T J and -J^T r for (log a, k) of every pair, with Kaufman's Jacobian.

    J_theta = -(1 - Q Q^T) (dPhi/dtheta) C: each theta moves two columns of Phi only, so with
    (1 - Q Q^T) dPhi = U E, U of two orthonormal columns a theta, J^T J is (U^T U) * (E C)(E C)^T
    summed over 2 x 2 blocks.

    Notes
    -----
    A slow mode is nearly a polynomial of the core: C is large, and little is left of dPhi beside
    Phi. Their product is formed first; products of each with itself would lose all digits, and
    J^T J come out with negative diagonals.
    """
    spectrum, C, residual, _, Q, Phi = best
    m = 2 * (len(spectrum.le) + len(spectrum.te))
    dPhi = _rates(spectrum, t, Phi[:, spectrum.size - m :]).reshape(m, len(t), 2)
    below = np.zeros((m, spectrum.size, 2))
    U, E = np.linalg.qr(np.concatenate([dPhi, below], axis=1) - Q @ (Q[: len(t)].T @ dPhi))
    pairs = C[spectrum.size - m :].reshape(m // 2, 2, C.shape[1])
    EC = (E @ np.repeat(pairs, 2, axis=0)).reshape(2 * m, C.shape[1])
    U = U.transpose(1, 0, 2).reshape(len(Q), 2 * m)
    g = ((U.T @ residual) * EC).sum(axis=1).reshape(m, 2).sum(axis=1)
    H = ((U.T @ U) * (EC @ EC.T)).reshape(m, 2, m, 2).sum(axis=(1, 3))
    return np.asarray(H), np.asarray(g)


def _rates(spectrum: Spectrum, t: Vector, modes: Array) -> Array:
    """Derivatives of every pair of modes by log a and by k, (pairs, 2, N, 2)."""
    le, te = spectrum.le, spectrum.te
    tau = np.concatenate([le[:, :1] * t, te[:, :1] * (1.0 - t)])
    k = np.concatenate([le[:, 1:], te[:, 1:]])
    y1, y2 = modes.T[::2], modes.T[1::2]
    large = np.abs(k) >= SERIES
    series = -(tau**3) * np.exp(-tau) * (1.0 / 6.0 - k * tau**2 / 60.0)
    dy2 = np.where(large, (tau * y1 - y2) / np.where(large, 2.0 * k, 1.0), series)
    by_log_a = np.stack([tau * (-y1 - k * y2), tau * (y1 - y2)], axis=-1)
    by_k = np.stack([-0.5 * tau * y2, dy2], axis=-1)
    return np.stack([by_log_a, by_k], axis=1)
