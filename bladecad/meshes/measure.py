"""How far the triangles of a blade are from it."""

from __future__ import annotations

from typing import Final

import numpy as np

from bladecad.arrays import Array, Vector
from bladecad.meshes.numbering import Numbering
from bladecad.meshes.places import at_places
from bladecad.surface.blade import BladeSurface, SideName
from bladecad.surface.ruled import Triangles

MIDDLES: Final = np.array(
    [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5], [1 / 3, 1 / 3, 1 / 3]]
)  # barycentric: of the edges, and of the triangle


def away_from_sides(
    surface: BladeSurface, name: SideName, numbered: Numbering, triangles: Triangles
) -> float:
    """Largest distance, along the normal, of edge and triangle middles from one side, mm."""
    if not len(triangles):
        return 0.0
    u, t, flat, n = _middles(numbered, triangles)
    away = at_places(surface, name, u, t) - flat
    return float(np.abs(np.einsum("kx,kx->k", away, n)).max())


def away_from_ruled(surface: BladeSurface, numbered: Numbering, triangles: Triangles) -> float:
    """The same from the face ruled between both sides: hub, tip, and blunt edges, mm."""
    if not len(triangles):
        return 0.0
    u, t, flat, n = _middles(numbered, triangles)
    s = (MIDDLES @ numbered.s[triangles].T).ravel()[:, None]
    S, P = at_places(surface, "suction", u, t), at_places(surface, "pressure", u, t)
    away = (1.0 - s) * S + s * P - flat
    return float(np.abs(np.einsum("kx,kx->k", away, n)).max())


def _middles(numbered: Numbering, triangles: Triangles) -> tuple[Vector, Vector, Array, Array]:
    """u, t, place on the triangle and its unit normal, for the four middles of each."""
    X = numbered.vertices[triangles]
    n = np.cross(X[:, 1] - X[:, 0], X[:, 2] - X[:, 0])
    n = n / np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-300)
    u, t = ((MIDDLES @ a[triangles].T).ravel() for a in (numbered.u, numbered.t))
    flat = np.einsum("mc,kcx->mkx", MIDDLES, X).reshape(-1, 3)
    return u, t, flat, np.tile(n, (len(MIDDLES), 1))
