"""Variable projection: the rates of the modes that let one spectrum follow all sections."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from scipy.linalg import lstsq, qr, solve_triangular

from bladecad.arrays import Array, Vector, seal
from bladecad.fit.spectrum import Spectrum, decay

LOG_A = (np.log(8.0), 8.5)
K = (-0.9, 20.0)
START_LOG_A, START_K = (np.log(30.0), np.log(500.0)), 0.4
SERIES = 1e-4  # |k| below which d/dk of a mode is taken from its series
RIDGE = 1e-11  # columns whose pivot falls below this share of the first are left out


@final
@dataclass(frozen=True, eq=False)
class Projection:
    """A spectrum with the best coefficients for it.

    spectrum     : Spectrum
    coefficients : (n, d) float, for the columns of the data
    rss          : sum of squared residuals
    rank         : columns of the basis that the data can tell apart
    steps        : iterations taken
    """

    spectrum: Spectrum
    coefficients: Array
    rss: float
    rank: int
    steps: int

    def __post_init__(self) -> None:
        seal(self, coefficients=(self.spectrum.size, None))


def first_guess(le: int, te: int, degree: int, knots: Vector | None = None) -> Spectrum:
    """Spread the rates evenly over their usual range, the start from which the search converges."""
    knots = np.empty(0) if knots is None else knots
    return Spectrum(degree, _spread(le), _spread(te), knots)


def _spread(pairs: int) -> Array:
    low, high = START_LOG_A
    places = (np.arange(pairs) + 0.5) / max(pairs, 1)
    return np.column_stack([np.exp(low + (high - low) * places), np.full(pairs, START_K)])


def project(spectrum: Spectrum, t: Vector, Y: Array, *, steps: int = 40) -> Projection:
    """Find the rates (a, k) for which some coefficients follow the data best.

    Minimises min_C |Phi(a, k) C - Y|^2 over log a and k.

    Parameters
    ----------
    spectrum : Spectrum
        Start of the search; its degree, number of pairs and knots stay.
    t : (N,) float
    Y : (N, d) float, mm
        All sections of a side side by side, 3 columns each, centred.
    steps : int
        Most Levenberg-Marquardt steps.

    Notes
    -----
    Golub and Pereyra, SIAM J. Numer. Anal. 10 (1973), with Kaufman's Jacobian,
    J_theta = -(1 - Q Q^T) (dPhi/dtheta) C; each theta moves two columns only, so J^T J is a sum
    of 2 x 2 blocks of (D^T D) * (C C^T) and the data enter once a step.
    """
    theta, damping = _pack(spectrum), 1e-3
    best = _linear(spectrum, t, Y)
    for step in range(steps if len(theta) else 0):
        H, g = _normal_equations(best, t)
        improved = False
        while damping < 1e8:
            move = _damped(H, g, damping)
            trial = _clip(theta + np.clip(move, -1.0, 1.0))
            found = _linear(_unpack(trial, spectrum), t, Y)
            if found[3] < best[3]:
                improved = True
                break
            damping *= 8.0
        if not improved:
            break
        gain = 1.0 - found[3] / best[3]
        theta, best, damping = trial, found, max(damping / 5.0, 1e-9)
        if gain < 1e-4:
            break
    spectrum, C, _, rss, rank, *_ = best
    return Projection(spectrum, C, rss, rank, step + 1 if len(theta) else 0)


def _linear(spectrum: Spectrum, t: Vector, Y: Array):  # type: ignore[no-untyped-def]
    Phi = spectrum(t)
    Q, R, order = qr(Phi, mode="economic", pivoting=True)
    d = np.abs(np.diag(R))
    rank = int(np.sum(d > RIDGE * d[0]))
    Q = Q[:, :rank]
    QY = Q.T @ Y
    C = np.zeros((Phi.shape[1], Y.shape[1]))
    C[order[:rank]] = solve_triangular(R[:rank, :rank], QY)
    residual = Y - Q @ QY
    return spectrum, C, residual, float(np.einsum("nd,nd->", residual, residual)), rank, Q


def _normal_equations(best, t):  # type: ignore[no-untyped-def]
    spectrum, C, residual, _, _, Q = best
    first = spectrum.degree + 1
    D, rows = [], []
    for a, k, tau in _modes(spectrum, t):
        y1, y2 = decay(tau, k)
        D += [np.column_stack([tau * (-y1 - k * y2), tau * (y1 - y2)])]
        D += [np.column_stack([-0.5 * tau * y2, _dk(tau, k, y1, y2)])]
        rows += [(first, first + 1)] * 2
        first += 2
    dPhi = np.concatenate(D, axis=1)
    g = np.einsum("jd,jd->j", dPhi.T @ residual, C[np.ravel(rows)]).reshape(-1, 2).sum(axis=1)
    dPhi = dPhi - Q @ (Q.T @ dPhi)
    Cs = C[np.ravel(rows)]
    H = (dPhi.T @ dPhi) * (Cs @ Cs.T)
    m = len(rows)
    return H.reshape(m, 2, m, 2).sum(axis=(1, 3)), g


def _damped(H: Array, g: Vector, damping: float) -> Vector:
    """Levenberg-Marquardt step, scaled so that all parameters count alike."""
    scale = np.sqrt(np.maximum(np.diag(H), 0.0) + 1e-14 * abs(np.trace(H)))
    scaled = H / np.outer(scale, scale) + damping * np.eye(len(g))
    return np.asarray(lstsq(scaled, g / scale)[0] / scale)


def _modes(spectrum: Spectrum, t: Vector):  # type: ignore[no-untyped-def]
    for a, k in spectrum.le:
        yield a, k, a * t
    for a, k in spectrum.te:
        yield a, k, a * (1.0 - t)


def _dk(tau: Vector, k: float, y1: Vector, y2: Vector) -> Vector:
    if abs(k) < SERIES:
        return np.asarray(-(tau**3) * np.exp(-tau) * (1.0 / 6.0 - k * tau**2 / 60.0))
    return np.asarray((tau * y1 - y2) / (2.0 * k))


def _pack(spectrum: Spectrum) -> Vector:
    modes = np.concatenate([spectrum.le, spectrum.te])
    return np.column_stack([np.log(modes[:, 0]), modes[:, 1]]).ravel()


def _unpack(theta: Vector, like: Spectrum) -> Spectrum:
    modes = theta.reshape(-1, 2)
    modes = np.column_stack([np.exp(modes[:, 0]), modes[:, 1]])
    cut = len(like.le)
    return Spectrum(like.degree, modes[:cut], modes[cut:], like.knots)


def _clip(theta: Vector) -> Vector:
    pairs = theta.reshape(-1, 2)
    return np.asarray(np.clip(pairs, (LOG_A[0], K[0]), (LOG_A[1], K[1])).ravel())
