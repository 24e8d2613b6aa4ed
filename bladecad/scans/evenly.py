"""The skin of a scan as points: those of a cloud, or places spread over the triangles of a mesh."""

from __future__ import annotations

import numpy as np

from bladecad.arrays import Mask, Points, Vector
from bladecad.data.scan import Scan


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
    corners = scan.points[scan.triangles[usable[scan.triangles].any(axis=1)]]
    area = 0.5 * np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    return _spread(corners, area, count, rng)


def _spread(corners: Points, area: Vector, count: int, rng: np.random.Generator) -> Points:
    """Places spread evenly over triangles."""
    run = np.cumsum(area)
    which = np.searchsorted(run, rng.random(count) * run[-1])
    s, t = rng.random((2, count))
    over = s + t > 1.0
    s, t = np.where(over, 1.0 - s, s)[:, None], np.where(over, 1.0 - t, t)[:, None]
    a, b, c = np.moveaxis(corners[np.minimum(which, len(area) - 1)], 1, 0)
    return np.asarray(a + s * (b - a) + t * (c - a))
