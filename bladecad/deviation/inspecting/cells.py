"""How fine the cells of a map may be: as fine as the points fill them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Vector, seal

Counts = NDArray[np.int64]

COARSEST: Final = (10, 20)  # cells over the span and along a side, where points are fewest
FINEST: Final = (3, 4)  # times that these may be halved
FULL = 8  # points on a cell that would reach both of its halves, were they evenly spread
BOTH = 0.8  # share of the full cells that have points on both halves
MOST = 0.5  # share of the cells with points that are full


@final
@dataclass(frozen=True, eq=False)
class Ruler:
    """Cells of equal width between limits: no cell lies in two zones.

    limits : (p + 1,) float, from 0 to 1
    counts : (p,) int, cells between each two of them
    """

    limits: Vector
    counts: Counts

    def __post_init__(self) -> None:
        seal(self, limits=(len(self.counts) + 1,))

    @cached_property
    def firsts(self) -> Counts:
        """Number of the first cell after each limit, and of all cells."""
        return np.concatenate([[0], np.cumsum(self.counts)])

    @cached_property
    def borders(self) -> Vector:
        """Borders of the cells, rising from 0 to 1."""
        return np.interp(np.arange(self.firsts[-1] + 1), self.firsts, self.limits)

    def cell(self, x: Vector) -> NDArray[np.int32]:
        """Number of the cell that holds each place."""
        number = np.interp(x, self.limits, self.firsts).astype(np.int32)
        return np.asarray(np.minimum(number, np.int32(self.firsts[-1] - 1)), dtype=np.int32)


def ruler(first: float, last: float, coarsest: int) -> Ruler:
    """Cut 0 .. 1 into cells, those of a first and a last stretch, maybe empty, apart."""
    limits = np.array([0.0, first, 1.0 - last, 1.0])
    there = np.diff(limits) > 0
    counts = np.maximum(np.round(coarsest * np.diff(limits)), 1).astype(np.int64)
    return Ruler(limits[np.append(True, there)], counts[there])


def halved(coarse: Ruler, times: int | list[int]) -> Ruler:
    """Halve the cells of a ruler, or those between each two limits, so many times."""
    return Ruler(coarse.limits, coarse.counts << np.asarray(times))


def halvings(count: Counts, along: Ruler, shape: tuple[float, float]) -> tuple[int, list[int]]:
    """How often cells may be halved: along u, and along t between each two limits.

    Parameters
    ----------
    count : (2, a, b) int
        Points on the finest cells.
    along : Ruler
        The coarsest cells along t.
    shape : (float, float)
        Height and length of a side, mm; the longer way of a cell is halved first.

    Notes
    -----
    A cell with eight points has points on both halves if they are evenly spread, but not if they
    lie on lines, such as those of a measuring machine: then it stays as wide in that direction.
    The longest stretch of t decides on u.
    """
    stretches = np.split(count, halved(along, FINEST[1]).firsts[1:-1], axis=2)
    body = int(np.argmax(along.counts))
    k = [0, 0]
    size = np.array(shape) / COARSEST
    going = {0, 1}
    while going:
        way = max(going, key=lambda i: size[i] / 2.0 ** k[i])
        if _may_halve(stretches[body], k, way):
            k[way] += 1
        else:
            going.remove(way)
    return k[0], [_halvings_along(stretch, k[0]) for stretch in stretches]


def _halvings_along(count: Counts, k: int) -> int:
    times = 0
    while _may_halve(count, [k, times], 1):
        times += 1
    return times


def _may_halve(count: Counts, k: list[int], way: int) -> bool:
    """Whether the points reach both halves of the cells that were halved k times."""
    if k[way] == FINEST[way]:
        return False
    left = [finest - times for finest, times in zip(FINEST, k, strict=True)]
    left[way] -= 1
    _, a, b = count.shape
    halves = count.reshape(2, a >> left[0], 1 << left[0], b >> left[1], 1 << left[1]).sum((2, 4))
    first, second = (
        np.take(halves, np.arange(end, halves.shape[1 + way], 2), 1 + way) for end in (0, 1)
    )
    full = first + second >= FULL
    if full.sum() < max(MOST * np.count_nonzero(first + second), 1):
        return False
    return bool(((first > 0) & (second > 0))[full].mean() >= BOTH)
