"""The hot loops over the points of a scan, compiled."""

# mypy: disable-error-code="untyped-decorator"
from __future__ import annotations

import numpy as np
from numba import njit
from numpy.typing import NDArray

from bladecad.arrays import Array, Vector


@njit(cache=True, nogil=True)
def four(knots: Vector, x: Vector, first: NDArray[np.int64], values: Array) -> None:
    """Find the first cubic that lives at each place, and the values of the four: Cox, de Boor."""
    last = len(knots) - 5
    for p in range(len(x)):
        low, high = 3, last + 1  # knots[low] <= x < knots[high], but at the ends
        while high - low > 1:
            middle = (low + high) // 2
            if knots[middle] <= x[p]:
                low = middle
            else:
                high = middle
        first[p] = low - 3
        values[p, 0] = 1.0
        for degree in range(1, 4):
            saved = 0.0
            for r in range(degree):
                right, left = knots[low + r + 1] - x[p], x[p] - knots[low + 1 - degree + r]
                share = values[p, r] / (right + left)
                values[p, r] = saved + right * share
                saved = left * share
            values[p, degree] = saved


@njit(cache=True, nogil=True)
def blend(
    first_u: NDArray[np.int64], values_u: Array, first_t: NDArray[np.int64], values_t: Array,
    poles: Array, found: Array,
) -> None:  # fmt: skip
    """Add B_k(u) phi_l(t) poles_kl over the four by four that live at each place."""
    for p in range(len(first_u)):
        k0, l0 = first_u[p], first_t[p]
        for a in range(4):
            for b in range(4):
                w = values_u[p, a] * values_t[p, b]
                for x in range(poles.shape[2]):
                    found[p, x] += w * poles[k0 + a, l0 + b, x]


@njit(cache=True, nogil=True)
def add(
    first_u: NDArray[np.int64], values_u: Array, first_t: NDArray[np.int64], values_t: Array,
    M: Array, f: Array, H: Array, g: Array,
) -> None:  # fmt: skip
    """Add B_k phi_l B_k' phi_l' M and B_k phi_l f of every point to H and g; see `Normal`."""
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
