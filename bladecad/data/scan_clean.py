"""What no scan should hold is dropped, and counted: NaN, repeated points, idle vertices."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Mask, Points

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
    up. Sorting rows costs ten times as much.
    """
    keys = _hash(points)
    ordered = np.sort(keys)
    twice = ordered[1:][ordered[1:] == ordered[:-1]]
    if not len(twice):
        return None, np.ones(len(points), bool)
    suspects = np.flatnonzero(np.isin(keys, twice))
    rows = points[suspects]
    _, first, inverse = np.unique(keys[suspects], return_index=True, return_inverse=True)
    if not np.array_equal(rows[first][inverse], rows, equal_nan=True):  # one key for two places
        _, first, inverse = np.unique(rows, axis=0, return_index=True, return_inverse=True)
    number = np.arange(len(points))
    number[suspects] = suspects[first][inverse.reshape(-1)]
    return number, number == np.arange(len(points))


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
