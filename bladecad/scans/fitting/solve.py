"""The sparse least-squares problem of a whole surface, block by block along the span."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.linalg import solveh_banded

from bladecad.arrays import Array
from bladecad.scans.fitting.freedom import Freedom, Pair
from bladecad.scans.fitting.local import ORDER
from bladecad.scans.fitting.normal import Normal, dense

COORDINATES: Final = ((0, 1), (1, 2))  # which product, xx xy yy, couples which coordinates


def best_move(
    free: Freedom, sums: tuple[Normal, Normal], roughness: tuple[Pair, Pair], now: Pair
) -> Array:
    """Solve for the move of the surface that makes up best for the distances of all points.

    Minimises sum w (n . d - distance)^2 + eps^2 (tau . d)^2 over the points, d their move, and the
    roughness of the surface after it.

    Parameters
    ----------
    free : Freedom
    sums : pair of Normal
        Of the suction and the pressure side.
    roughness : pair of Pair
        Weights of squared third differences of the local poles, along u (nt,), and along t
        (nt - 3,), a side.
    now : Pair
        Local poles of the surface as it is.

    Returns
    -------
    (nu, 2, f) float
    """
    nu, f = free.in_u.size, free.ways
    D = np.diff(np.eye(nu), 3, axis=0)
    along_u, along_t = D.T @ D, [_across(w) for w in roughness[1]]
    g = np.zeros((nu, 2, f))
    blocks = np.zeros((ORDER, nu, 2, f, 2, f))
    for T, normal, w, K, c in zip(free.local, sums, roughness[0], along_t, now, strict=True):
        pull = normal.g - np.einsum("kq,qla,l->kla", along_u, c, w) - np.einsum("lm,kma->kla", K, c)
        g += np.einsum("kla,lf->kaf", pull, T)
        W = np.einsum("lf,l,lg->fg", T, w, T)
        for dk in range(ORDER):
            parts = [T.T @ dense(normal, dk, part) @ T for part in range(3)]
            stiff = np.pad(np.diagonal(along_u, dk), (0, dk))[:, None, None] * W
            stiff = stiff + T.T @ K @ T if dk == 0 else stiff
            for a in range(2):
                for b in range(2):
                    own = parts[COORDINATES[a][b]]
                    blocks[dk, :, a, :, b] += own + stiff if a == b else own
    return _solved(blocks.reshape(ORDER, nu, 2 * f, 2 * f), g.reshape(-1)).reshape(nu, 2, f)


def _across(weights: Array) -> Array:
    D = np.diff(np.eye(len(weights) + 3), 3, axis=0)
    return np.asarray((D.T * weights) @ D)


def _solved(blocks: Array, g: Array) -> Array:
    """Solve the block-banded system; blocks[i, k] stands in block row k, block column k + i."""
    order, nu, b, _ = blocks.shape
    strips = np.concatenate(list(blocks), axis=2)  # (nu, b, order * b)
    ab = np.zeros((order * b, nu * b))
    for r in range(b):
        ab[: order * b - r, r::b] = strips[:, r, r:].T
    ab[0] += 1e-12 * ab[0].max()
    return np.asarray(solveh_banded(ab, g, lower=True, overwrite_ab=True, check_finite=False))
