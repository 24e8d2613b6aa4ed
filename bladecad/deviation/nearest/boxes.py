"""Boxes that certainly hold a square or a triangle, and a tree over them."""

from __future__ import annotations

from dataclasses import dataclass
from math import comb
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Points, seal
from bladecad.deviation.nearest.squares import P, Q

BITS: Final = 10  # of a Morton code, each axis


@final
@dataclass(frozen=True, eq=False)
class Tree:
    """A complete binary tree of boxes; node k has the children 2k + 1 and 2k + 2.

    lowest, highest : (2m - 1, 3) float, mm, corners of the boxes; empty where nothing is below
    item            : (m,) int, what leaf m - 1 + k holds, -1 where it is empty
    """

    lowest: Points
    highest: Points
    item: NDArray[np.int64]


@final
@dataclass(frozen=True, eq=False)
class Boxes:
    """A box along the axes of each square itself: as thin as the square is flat.

    centre, axes : (n, 3) and (n, 3, 3) float, mm and unit rows
    half         : (n, 3) float, mm
    """

    centre: Points
    axes: Array
    half: Points

    def __post_init__(self) -> None:
        n = len(self.centre)
        seal(self, centre=(n, 3), axes=(n, 3, 3), half=(n, 3))


def bernstein(c: Array) -> Points:
    """Poles of every square, whose hull holds it, (n, (P + 1)(Q + 1), 3)."""
    net = np.einsum("ki,lj,nijx->nklx", _to_bernstein(P), _to_bernstein(Q), c, optimize=True)
    return np.asarray(net.reshape(len(c), -1, 3))


def _to_bernstein(degree: int) -> Array:
    """x^i = sum_k C(k,i)/C(n,i) B_k(x); Farouki, CAGD 29 (2012), eq. (19)."""
    return np.array(
        [[comb(k, i) / comb(degree, i) for i in range(degree + 1)] for k in range(degree + 1)]
    )


def boxes(poles: Array) -> Boxes:
    """Bound sets of poles, (n, k, 3), along their own principal axes."""
    middle = poles.mean(axis=1, keepdims=True)
    away = poles - middle
    axes = np.ascontiguousarray(np.linalg.eigh(away.swapaxes(1, 2) @ away)[1].swapaxes(1, 2))
    local = away @ axes.swapaxes(1, 2)
    low, high = local.min(axis=1), local.max(axis=1)
    centre = middle[:, 0] + np.einsum("ni,nij->nj", 0.5 * (low + high), axes)
    return Boxes(centre, axes, 0.5 * (high - low))


def tree(lowest: Points, highest: Points) -> Tree:
    """Build the tree over boxes along x, y, z, in the order of the Morton code of their middles."""
    order = np.argsort(morton(0.5 * (lowest + highest)), kind="stable")
    m = 1 << max(len(order) - 1, 0).bit_length()
    low, high = np.full((2 * m - 1, 3), np.inf), np.full((2 * m - 1, 3), -np.inf)
    low[m - 1 : m - 1 + len(order)] = lowest[order]
    high[m - 1 : m - 1 + len(order)] = highest[order]
    while m > 1:
        level = slice(m - 1, 2 * m - 1)
        m //= 2
        low[m - 1 : 2 * m - 1] = low[level].reshape(m, 2, 3).min(axis=1)
        high[m - 1 : 2 * m - 1] = high[level].reshape(m, 2, 3).max(axis=1)
    item = np.full((len(low) + 1) // 2, -1)
    item[: len(order)] = order
    return Tree(low, high, item)


def morton(points: Points) -> NDArray[np.int64]:
    """Interleave the bits of x, y and z: near codes lie near in space (Morton 1966)."""
    low = points.min(axis=0)
    size = max(float(np.ptp(points, axis=0).max()), 1e-300)
    cell = ((points - low) * ((2**BITS - 1) / size)).astype(np.int64)
    code = np.zeros(len(points), np.int64)
    for x in range(3):
        code |= _apart(cell[:, x]) << x
    return code


def _apart(x: NDArray[np.int64]) -> NDArray[np.int64]:
    """Put two empty bits between any two bits of ten-bit numbers."""
    x = (x | (x << 16)) & 0x030000FF
    x = (x | (x << 8)) & 0x0300F00F
    x = (x | (x << 4)) & 0x030C30C3
    return np.asarray((x | (x << 2)) & 0x09249249)
