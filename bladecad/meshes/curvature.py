"""The curvature of the sides at the vertices of a mesh."""

from __future__ import annotations

import numpy as np

from bladecad.arrays import Vector
from bladecad.meshes.places import at_places
from bladecad.surface.blade import BladeSurface, SideName, outward


def largest_curvature(surface: BladeSurface, name: SideName, u: Vector, t: Vector) -> Vector:
    """The principal curvature of larger size at the places (u_k, t_k), (k,), 1/mm.

    Positive where convex; eigenvalues of the shape operator, as `principal_curvatures` on a grid.
    """
    Su, St = at_places(surface, name, u, t, 1, 0), at_places(surface, name, u, t, 0, 1)
    n = np.cross(Su, St)
    n *= outward(surface, name) / np.linalg.norm(n, axis=1, keepdims=True)
    E, F, G = (np.einsum("kx,kx->k", a, b) for a, b in ((Su, Su), (Su, St), (St, St)))
    e, f, g = (
        -np.einsum("kx,kx->k", at_places(surface, name, u, t, *d), n)
        for d in ((2, 0), (1, 1), (0, 2))
    )
    area = E * G - F**2
    H, K = 0.5 * (e * G - 2.0 * f * F + g * E) / area, (e * g - f**2) / area
    return np.asarray(H + np.copysign(np.sqrt(np.maximum(H**2 - K, 0.0)), H))
