"""A periodic line through noisy values: as smooth as the noise asks for, and no smoother."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh, solve
from scipy.sparse import csr_matrix

from bladecad.arrays import Array, Vector, seal

ORDER: Final = 2  # of the differences of coefficients that are kept small
STILL: Final = 0.1  # and these themselves, against their differences
HELD: Final = 0.02  # weight of both, as a share of the points
SLOPES: Final = 16  # functions for the change with the height
ROUNDS: Final = 3
CLEAR: Final = 2.5  # times the usual residual: values beyond count little
GRID: Final = np.logspace(-2.0, 6.0, 33)  # weights of smoothness that are tried
TENSION: Final = 0.05  # of first against second differences: no overshoot where points are missing
COST: Final = 1.2  # of a freedom, in cross-validation: a little smoother than best
MAD: Final = 1.4826


@final
@dataclass(frozen=True, eq=False)
class Smooth:
    """Periodic cubic spline over w in [0, 1), uniform.

    coefficients : (n,) float
    slope        : (m,) float, of its change with the height
    noise        : usual distance of the values from it
    freedom      : how many values it could follow
    """

    coefficients: Vector
    slope: Vector
    noise: float
    freedom: float

    def __post_init__(self) -> None:
        seal(self, coefficients=(None,), slope=(None,))

    def __call__(self, w: Vector) -> Vector:
        """Values at w, (k,)."""
        return np.asarray(periodic(w, len(self.coefficients)) @ self.coefficients)


def smooth(w: Vector, lift: Vector, y: Vector, count: int, stiff: float = 1.0) -> Smooth:
    """Fit y = f(w) + lift g(w), f as smooth as generalised cross-validation says, g coarse.

    Parameters
    ----------
    w : (k,) float
        From 0 to 1, periodic.
    lift : (k,) float
        Height above the section, about -1 .. 1.
    y : (k,) float
    count : int
        Coefficients of f.
    stiff : float
        Least weight of smoothness, times the usual.
    """
    (columns, B), (coarse, C) = _four(w, count), _four(w, SLOPES)
    A = _rows(
        np.hstack([columns, count + coarse]), np.hstack([B, lift[:, None] * C]), count + SLOPES
    )
    penalty = np.zeros((A.shape[1],) * 2)
    penalty[:count, :count] = _roughness(count, ORDER) + TENSION * _roughness(count, 1)
    held = np.zeros_like(penalty)
    held[count:, count:] = _roughness(SLOPES, 1) + STILL * np.eye(SLOPES)
    weight, lam = np.ones(len(y)), None
    for k in range(ROUNDS):
        chosen = stiff * GRID if k in (0, ROUNDS - 1) else np.array([lam])
        c, freedom, lam = _cross_validated(A, y, weight, penalty, held, chosen)
        off = np.abs(y - A @ c)
        noise = MAD * float(np.median(off))
        if k < ROUNDS - 1:
            weight = 1.0 / (1.0 + (off / max(CLEAR * noise, 1e-12)) ** 2) ** 2
    return Smooth(c[:count], c[count:], noise, freedom)


def periodic(w: Vector, count: int) -> csr_matrix:
    """Uniform periodic cubic B-splines at w, (k, count), sparse."""
    return _rows(*_four(w, count), count)


def _four(w: Vector, count: int) -> tuple[NDArray[np.int64], Array]:
    """Which of them live at w, and their values there, (k, 4)."""
    place = np.mod(w, 1.0) * count
    first = np.floor(place).astype(np.int64)
    s = place - first
    values = (
        np.stack(
            [(1 - s) ** 3, 3 * s**3 - 6 * s**2 + 4, -3 * s**3 + 3 * s**2 + 3 * s + 1, s**3], axis=1
        )
        / 6.0
    )
    return (first[:, None] + np.arange(-1, 3)) % count, values


def _rows(columns: NDArray[np.int64], values: Array, count: int) -> csr_matrix:
    """Sparse matrix, (k, count), from the columns and values of its rows, (k, n) each."""
    k, n = columns.shape
    ends = np.arange(0, k * n + 1, n)
    return csr_matrix((values.ravel(), columns.ravel(), ends), shape=(k, count))


def _cross_validated(
    A: csr_matrix, y: Vector, weight: Vector, P: Array, held: Array, grid: Vector
) -> tuple[Vector, float, float]:
    """Penalised least squares whose weight of smoothness predicts left-out values best."""
    W = csr_matrix((A.data * np.repeat(weight, np.diff(A.indptr)), A.indices, A.indptr), A.shape)
    G, r, yy = (A.T @ W).toarray(), np.asarray(W.T @ y), float(weight @ y**2)
    scale = np.trace(G) / np.trace(P)
    G += HELD * len(y) / SLOPES * held
    G0 = G + 1e-9 * scale * P + 1e-13 * np.trace(G) / len(G) * np.eye(len(G))
    if len(grid) == 1:
        return np.asarray(solve(G0 + grid[0] * scale * P, r, assume_a="pos")), 0.0, grid[0]
    e, V = eigh(P * scale, G0)
    b, n = V.T @ r, float(weight.sum())
    shrink = 1.0 / (1.0 + grid[:, None] * np.maximum(e, 0.0))
    left = yy - (shrink * (2.0 - shrink)) @ b**2
    df = shrink.sum(axis=1)
    best = int(np.argmin(np.maximum(left, 0.0) / np.maximum(n - COST * df, 1e-3 * n) ** 2))
    return V @ (b * shrink[best]), float(df[best]), float(grid[best])


def _roughness(count: int, order: int) -> Array:
    """Sum of the squared differences of periodic coefficients."""
    D = np.eye(count)
    for _ in range(order):
        D = np.roll(D, -1, axis=0) - D
    return D.T @ D
