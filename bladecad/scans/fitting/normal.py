"""Normal equations of a tensor-product spline surface, summed point by point where they live."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np

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
    from bladecad.scans.fitting.kernels import add

    H = np.zeros((in_u.size, in_t.size, ORDER, AROUND, 3))
    g = np.zeros((in_u.size, in_t.size, 2))
    add(*in_u.four(u), *in_t.four(t), M, f, H, g)
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
