"""A skin of triangles: the nearest place of a mesh to each point."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Points, seal
from bladecad.deviation.nearest.boxes import Tree, tree
from bladecad.deviation.nearest.skin import Found, in_chunks
from bladecad.errors import DataError


@final
@dataclass(frozen=True, eq=False)
class TriangleSkin:
    """Triangles ready to be searched.

    corners : (m, 3, 3) float, mm, counter-clockwise from outside
    normals : (m, 3) float, unit, outwards
    tree    : Tree
    """

    corners: Array
    normals: Points
    tree: Tree

    def __post_init__(self) -> None:
        m = len(self.corners)
        seal(self, corners=(m, 3, 3), normals=(m, 3))


def triangle_skin(vertices: Points, triangles: NDArray[np.int64]) -> TriangleSkin:
    """Build the tree over triangles; those without an area are left out.

    Raises
    ------
    DataError
        If none has an area.
    """
    corners = np.asarray(vertices, dtype=np.float64)[triangles]
    n = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    twice = np.linalg.norm(n, axis=1)
    longest = np.linalg.norm(np.roll(corners, 1, axis=1) - corners, axis=2).max(axis=1)
    flat = twice <= 1e-12 * longest**2
    if flat.all():
        raise DataError("no triangle of the nominal has an area; give another mesh")
    corners, n = corners[~flat], n[~flat] / twice[~flat, None]
    return TriangleSkin(corners, n, tree(corners.min(axis=1), corners.max(axis=1)))


def search_triangles(skin: TriangleSkin, points: Points) -> Found:
    """Find the nearest place of the triangles to each point, on all cores."""
    from bladecad.deviation.nearest.triangle_kernel import nearest

    T = skin.tree

    def job(points: Points, order: NDArray[np.int64], found: Found) -> int:
        nearest(
            points, order, T.lowest, T.highest, T.item, skin.corners, skin.normals,
            found.item, found.place, found.distance, found.foot, found.normal,
        )  # fmt: skip
        return 0

    return in_chunks(points, job)
