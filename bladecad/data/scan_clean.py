"""What no scan should hold is dropped, and counted: NaN, repeated points, idle vertices."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Mask, Points, Vector

Triangles = NDArray[np.int64]


def cleaned(
    points: Points, triangles: Triangles | None = None, *, soup: bool = False
) -> tuple[Points, Triangles | None, tuple[str, ...]]:
    """Return the points that say something, in their order, and what was dropped.

    Parameters
    ----------
    points : (k, 3) float
    triangles : (m, 3) int, optional
        Numbers of points; renumbered.
    soup : bool
        Each triangle brought its own three points, as in STL: repeated ones are no fault.
    """
    number, kept = _first_of_each(points)
    finite: Mask = np.asarray(np.isfinite(points).all(axis=1))
    used = np.ones(len(points), bool)
    said = {"not finite": int((~finite).sum())}
    repeated = int((finite & ~kept).sum())
    said |= {} if soup else {"repeated": repeated}
    if triangles is not None:
        triangles = triangles if number is None else number[triangles]
        good = finite[triangles].all(axis=1) & _spans(triangles)
        used = np.zeros(len(points), bool)
        used[triangles[good]] = True
        said |= {"without a triangle": int((finite & kept & ~used).sum())}
        said |= {"triangles degenerate": int((~good).sum())}
        triangles = triangles[good]
    keep = finite & kept & used
    if triangles is not None and not keep.all():
        triangles = (np.cumsum(keep) - 1)[triangles]
    return (points if keep.all() else points[keep]), triangles, tuple(_sentences(said))


def _sentences(said: dict[str, int]) -> Iterator[str]:
    for what, count in said.items():
        if count and "triangles" in what:
            yield f"{count} degenerate triangles dropped"
        elif count:
            yield f"{count} points {what}, dropped"


def _spans(triangles: Triangles) -> Mask:
    a, b, c = triangles.T
    return np.asarray((a != b) & (b != c) & (c != a))


def _first_of_each(points: Points) -> tuple[NDArray[np.int64] | None, Mask]:
    """Number of the first point at the same place for every point, None where all differ.

    Places are compared by a hash of their 192 bits; that equal hashes are equal places is looked
    at, and rows are sorted where two places share one. That costs ten times as much.
    """
    keys = _hash(points)
    ordered = np.sort(keys)
    if not (ordered[1:] == ordered[:-1]).any():
        return None, np.ones(len(points), bool)
    number = _firsts(np.argsort(keys), np.flatnonzero(np.diff(ordered, prepend=~ordered[:1])))
    later = np.flatnonzero(number != np.arange(len(points)))
    if not all(_same(column[later], column[number[later]]) for column in points.T):
        rows = np.unique(points + 0.0, axis=0, return_inverse=True)[1].reshape(-1)
        order = np.argsort(rows, kind="stable")
        number = _firsts(order, np.flatnonzero(np.diff(rows[order], prepend=-1)))
    return number, number == np.arange(len(points))


def _firsts(order: NDArray[np.int64], starts: NDArray[np.int64]) -> NDArray[np.int64]:
    """The smallest number of each group, for all its members."""
    number = np.empty(len(order), np.int64)
    size = np.diff(starts, append=len(order))
    number[order] = np.repeat(np.minimum.reduceat(order, starts), size)
    return number


def _same(a: Vector, b: Vector) -> bool:
    return bool(((a == b) | (np.isnan(a) & np.isnan(b))).all())


def _hash(points: Points) -> NDArray[np.uint64]:
    """A number for every place (multiply and shift, as in splitmix64); -0 is 0."""
    key = np.zeros(len(points), np.uint64)
    for column in points.T:
        key ^= (np.ascontiguousarray(column) + 0.0).view(np.uint64)
        key *= np.uint64(0x9E3779B97F4A7C15)
        key ^= key >> np.uint64(29)
        key *= np.uint64(0xBF58476D1CE4E5B9)
        key ^= key >> np.uint64(32)
    return key
