"""A skin that feet can be found on: squares, their boxes, the tree over them."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from os import cpu_count
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Points, Vector, seal
from bladecad.deviation.nearest.boxes import Boxes, Tree, bernstein, boxes, morton, tree
from bladecad.deviation.nearest.squares import P, Q, Squares

GROUP: Final = 0.4  # of half the diagonal of a square: points so near share a search
CHUNK: Final = 1 << 20  # points; what a thread holds at a time


@final
@dataclass(frozen=True, eq=False)
class Skin:
    """Squares ready to be searched.

    start : (n, 3, 3) float, X in the middle of each square, and the rows of the pseudo-inverse of
            (X_v, X_w) there: (v, w) = 1/2 + J^+ (x - X) is where Newton's method begins
    """

    squares: Squares
    boxes: Boxes
    tree: Tree
    start: Array

    def __post_init__(self) -> None:
        seal(self, start=(len(self.squares.c), 3, 3))


@final
@dataclass(frozen=True, eq=False)
class Found:
    """What the search found for each point.

    item      : (k,) int, square or triangle
    place     : (k, 2) float, in it
    distance  : (k,) float, mm, positive on the outer side
    foot      : (k, 3) float, mm
    normal    : (k, 3) float, unit, outwards; zero in a corner that is a point
    unsettled : how many points the search left before their foot stood still
    """

    item: NDArray[np.int64]
    place: Points
    distance: Vector
    foot: Points
    normal: Points
    unsettled: int


def skin_of(squares: Squares) -> Skin:
    """Bound the squares and build the tree over them."""
    net = bernstein(squares.c)
    return Skin(squares, boxes(net), tree(net.min(axis=1), net.max(axis=1)), _middles(squares.c))


def search(skin: Skin, points: Points) -> Found:
    """Find the nearest place of the skin to each point, on all cores."""
    from bladecad.deviation.nearest.kernel import nearest

    T, B, S = skin.tree, skin.boxes, skin.squares
    reach = GROUP * float(np.median(np.linalg.norm(B.half, axis=1)))

    def job(points: Points, order: NDArray[np.int64], found: Found) -> int:
        return int(
            nearest(
                points, order, T.lowest, T.highest, T.item, B.centre, B.axes, B.half, skin.start,
                S.c, S.sign, found.item, found.place, found.distance, found.foot, found.normal,
                reach,
            )
        )  # fmt: skip

    return in_chunks(points, job)


def in_chunks(points: Points, job: Callable[[Points, NDArray[np.int64], Found], int]) -> Found:
    """Run a search over parts of the points, each sorted so that neighbours follow each other."""
    points = np.ascontiguousarray(points, dtype=np.float64)
    k = len(points)
    found = Found(
        np.empty(k, np.int64), np.empty((k, 2)), np.empty(k), np.empty((k, 3)), np.empty((k, 3)), 0
    )

    def part(begin: int) -> int:
        rows = slice(begin, begin + chunk)
        into = Found(
            found.item[rows], found.place[rows], found.distance[rows], found.foot[rows],
            found.normal[rows], 0,
        )  # fmt: skip
        return job(points[rows], np.argsort(morton(points[rows])), into)

    threads = cpu_count() or 1
    chunk = int(np.clip(-(-k // threads), 1, CHUNK))
    with ThreadPoolExecutor(threads) as pool:
        unsettled = sum(pool.map(part, range(0, k, chunk)))
    return Found(found.item, found.place, found.distance, found.foot, found.normal, unsettled)


def _middles(c: Array) -> Array:
    V, W = (0.5 ** np.arange(k + 1) for k in (P, Q))
    Vd, Wd = (np.arange(k + 1) * 0.5 ** np.maximum(np.arange(k + 1) - 1.0, 0.0) for k in (P, Q))
    X, Xv, Xw = (
        np.einsum("i,j,nijx->nx", a, b, c, optimize=True) for a, b in ((V, W), (Vd, W), (V, Wd))
    )
    return np.concatenate([X[:, None], np.linalg.pinv(np.stack([Xv, Xw], axis=2))], axis=1)
