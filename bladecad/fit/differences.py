"""Differences of points, and the field that best matches them, eqs. (2)-(7)."""

from __future__ import annotations

from typing import Literal, TypeAlias

import numpy as np

from bladecad.arrays import Array, Points, Vector

Model: TypeAlias = Literal["paper", "affine", "second-order"]
Scheme: TypeAlias = Literal["forward", "midpoint"]
Solver: TypeAlias = Literal["lstsq", "normal"]

EPS = float(np.finfo(np.float64).eps)


def differences(y: Points, steps: Vector, model: Model, scheme: Scheme) -> tuple[Array, Array]:
    """Return states z_n, one a row, and the differences to be matched by A z_n, eq. (2)."""
    slopes = np.diff(y, axis=0) / steps[:, None]
    if model != "second-order":
        x = y[:-1] if scheme == "forward" else (y[:-1] + y[1:]) / 2
        return (x if model == "paper" else _with_one(x)), slopes
    if scheme == "forward":
        x, v, apart = y[:-2], slopes[:-1], steps[:-1]
    else:
        apart = (steps[:-1] + steps[1:]) / 2
        late = (steps[:-1] / (2 * apart))[:, None]
        x, v = y[1:-1], (1 - late) * slopes[:-1] + late * slopes[1:]
    return _with_one(np.hstack([x, v])), np.diff(slopes, axis=0) / apart[:, None]


def regress(Z: Array, D: Array, solver: Solver) -> tuple[Array, int, float]:
    """Minimise |Z M^T - D| over M; return M, the rank of Z, and the condition of the solve.

    "normal" is eq. (7), M = D^T Z (Z^T Z)^-1, its inverse taken on the directions visited.
    """
    inverted, wanted = (Z, D) if solver == "lstsq" else (Z.T @ Z, Z.T @ D)
    U, singular, Vt = np.linalg.svd(inverted, full_matrices=False)
    rank = int(np.sum(singular > EPS * len(Z) * singular[0]))
    kept = singular[:rank]
    M = (wanted.T @ U[:, :rank] / kept) @ Vt[:rank]
    return np.asarray(M), rank, float(np.max(kept, initial=0.0) / np.min(kept, initial=np.inf))


def _with_one(x: Array) -> Array:
    return np.column_stack([x, np.ones(len(x))])
