"""The skin of a scan as points: those of a cloud, or places spread over the triangles of a mesh."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Mask, Points, Vector
from bladecad.data.scan import Scan

LARGER: Final = 30.0  # times the usual edge (geometric mean) at all of its vertices
SELDOM: Final = 0.01  # of the triangles; more is how the mesh was made


def skin(scan: Scan, count: int, usable: Mask, inside: Mask | None = None) -> Points:
    """Points of the skin in no order, about `count`, (k, 3), mm.

    Parameters
    ----------
    scan : Scan
    count : int
        More is not needed; a cloud may have fewer.
    usable : (k,) bool
        Points of the scan that count.
    inside : (k,) bool, optional
        Points of the scan near which places are wanted.

    Notes
    -----
    A mesh is cut by its triangles rather than by its vertices, which may be far apart where it is
    flat; nothing is asked of its normals, of its edges, or that it be closed.
    """
    rng = np.random.default_rng(0)
    usable = usable if inside is None else usable & inside
    if scan.triangles is None:
        which = np.flatnonzero(usable)
        if len(which) > count:
            which = rng.choice(which, count, replace=False)
        return np.asarray(scan.points[rng.permutation(which)])
    kept = usable[scan.triangles].any(axis=1) & ~astray(scan.points, scan.triangles)
    corners = scan.points[scan.triangles[kept]]
    area = 0.5 * np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    return _spread(corners, area, count, rng)


def astray(points: Points, triangles: NDArray[np.int64]) -> Mask:
    """Triangles that are far too large among those beside them: vertices joined at random, (m,)."""
    ends = np.concatenate([triangles[:, [i, j]] for i, j in ((0, 1), (1, 2), (2, 0))])
    length = np.linalg.norm(points[ends[:, 0]] - points[ends[:, 1]], axis=1)
    log = np.log(np.maximum(length, 1e-300))
    edges = np.bincount(ends.ravel(), minlength=len(points))
    mean = np.bincount(ends.ravel(), np.repeat(log, 2), minlength=len(points))
    usual = mean / np.maximum(edges, 1)
    largest = log.reshape(3, -1).max(axis=0)
    out = np.asarray(largest > np.log(LARGER) + usual[triangles].max(axis=1))
    return out if out.mean() < SELDOM else np.zeros(len(out), bool)


def _spread(corners: Points, area: Vector, count: int, rng: np.random.Generator) -> Points:
    """Places spread evenly over triangles."""
    run = np.cumsum(area)
    which = np.searchsorted(run, rng.random(count) * run[-1])
    s, t = rng.random((2, count))
    over = s + t > 1.0
    s, t = np.where(over, 1.0 - s, s)[:, None], np.where(over, 1.0 - t, t)[:, None]
    a, b, c = np.moveaxis(corners[np.minimum(which, len(area) - 1)], 1, 0)
    found: Points = a + s * (b - a) + t * (c - a)
    return found
