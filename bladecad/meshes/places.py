"""S at very many places that share few parameters t, in little memory."""

from __future__ import annotations

from typing import Final

import numpy as np

from bladecad.arrays import Array, Vector
from bladecad.surface.blade import BladeSurface, SideName

AT_ONCE: Final = 50_000


def at_places(
    surface: BladeSurface, name: SideName, u: Vector, t: Vector, du: int = 0, dt: int = 0
) -> Array:
    """S or a partial derivative at the places (u_k, t_k), (k, 3), mm.

    As `surface.at`, but every t is evaluated once: on lines t = const there are few.
    """
    lines, which = np.unique(t, return_inverse=True)
    curves = np.ascontiguousarray(surface.side(name)(lines, dt).transpose(1, 0, 2))
    found = np.empty((len(u), 3))
    for start in range(0, len(u), AT_ONCE):
        some = slice(start, start + AT_ONCE)
        blend = surface.blend(u[some], du)
        found[some] = np.einsum("ki,kix->kx", blend, curves[which[some]])
    return found
