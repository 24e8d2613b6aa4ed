"""Normal equations of a tensor-product spline surface, summed point by point where they live."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any, Final, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Vector
from bladecad.scans.fitting.local import ORDER, Splines

AROUND: Final = 2 * ORDER - 1  # neighbours of a function, itself among them


@final
@dataclass(frozen=True, eq=False)
class Normal:
    """Sums over the points of one side.

    H : (nu, nt, 4, 7, 3) float; of functions (k, l) and (k + i, l + j - 3), of the products of the
        two coordinates of the displacement, xx, xy, yy
    g : (nu, nt, 2) float; the right-hand side
    """

    H: Array
    g: Array


def accumulate(in_u: Splines, in_t: Splines, u: Vector, t: Vector, M: Array, f: Array) -> Normal:
    """Sum B_k phi_l B_k' phi_l' M and B_k phi_l f over the points.

    Parameters
    ----------
    in_u, in_t : Splines
    u, t : (k,) float, places of the foot points
    M : (k, 3) float; weights of the displacement, m_xx, m_xy, m_yy
    f : (k, 2) float; weighted distances to be made up for, mm
    """
    first_u, values_u = in_u.four(u)
    first_t, values_t = in_t.four(t)
    H = np.zeros((in_u.size, in_t.size, ORDER, AROUND, 3))
    g = np.zeros((in_u.size, in_t.size, 2))
    _compiled()(first_u, values_u, first_t, values_t, M, f, H, g)
    return Normal(H, g)


def dense(normal: Normal, dk: int, part: int) -> Array:
    """Blocks (k, k + dk) of one product of coordinates, (nu, nt, nt); rows past the end are 0."""
    H = normal.H[:, :, dk, :, part]
    nu, nt = H.shape[:2]
    blocks = np.zeros((nu, nt, nt + AROUND - 1))
    rows = np.arange(nt)
    for j in range(AROUND):
        blocks[:, rows, rows + j] = H[:, :, j]
    return blocks[:, :, ORDER - 1 : ORDER - 1 + nt]


def _add(
    first_u: NDArray[np.intp], values_u: Array, first_t: NDArray[np.intp], values_t: Array,
    M: Array, f: Array, H: Array, g: Array,
) -> None:  # fmt: skip
    for p in range(len(first_u)):
        k0, l0 = first_u[p], first_t[p]
        xx, xy, yy = M[p, 0], M[p, 1], M[p, 2]
        for a in range(4):
            for b in range(4):
                w = values_u[p, a] * values_t[p, b]
                g[k0 + a, l0 + b, 0] += w * f[p, 0]
                g[k0 + a, l0 + b, 1] += w * f[p, 1]
                for c in range(a, 4):
                    wc = w * values_u[p, c]
                    for d in range(4):
                        v = wc * values_t[p, d]
                        H[k0 + a, l0 + b, c - a, d - b + 3, 0] += v * xx
                        H[k0 + a, l0 + b, c - a, d - b + 3, 1] += v * xy
                        H[k0 + a, l0 + b, c - a, d - b + 3, 2] += v * yy


@cache
def _compiled() -> Any:
    from numba import njit

    return njit(cache=True, nogil=True)(_add)
