"""Inside or outside of a closed mesh."""

from __future__ import annotations

import numpy as np

from bladecad.arrays import Vector
from bladecad.meshes.named import NamedMesh


def winding(mesh: NamedMesh, place: Vector) -> float:
    """How often a closed mesh goes round a place: 1 inside, 0 outside.

    The solid angle over 4 pi; of each triangle
    tan(w/2) = a.(b x c) / (abc + (a.b)c + (b.c)a + (c.a)b), Van Oosterom and Strackee, 1983.
    """
    a, b, c = np.moveaxis(mesh.vertices[mesh.triangles] - place, 1, 0)
    la, lb, lc = (np.linalg.norm(x, axis=1) for x in (a, b, c))
    above = np.einsum("kx,kx->k", a, np.cross(b, c))
    below = la * lb * lc + sum(
        np.einsum("kx,kx->k", x, y) * lz for x, y, lz in ((a, b, lc), (b, c, la), (c, a, lb))
    )
    return float(np.arctan2(above, below).sum() / (2.0 * np.pi))


def a_place_inside(mesh: NamedMesh, depth: float, patch: str = "inlet") -> Vector:
    """A place so deep behind the middle of the largest triangle of a patch, (3,), mm."""
    X = mesh.vertices[mesh.patches[patch]]
    n = np.cross(X[:, 1] - X[:, 0], X[:, 2] - X[:, 0])
    area = np.linalg.norm(n, axis=1)
    k = int(np.argmax(area))
    return np.asarray(X[k].mean(axis=0) - depth * n[k] / area[k])
