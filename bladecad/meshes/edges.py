"""Where the leading and trailing edge end and the sides begin."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Vector
from bladecad.surface.blade import BladeSurface, SideName, normals
from bladecad.surface.loft import SIDES, graded

ROUND: Final = 0.1  # of the largest curvature of the edge: below it a side has begun
WIDEST: Final = 0.1  # of t
Widths = tuple[float, float]  # in t, on the suction and on the pressure side


def edge_zones(surface: BladeSurface) -> tuple[Widths, Widths]:
    """Widths of the zones of leading and trailing edge on both sides, by curvature.

    A section is bent round its edge and nearly straight along its sides. On each side the zone
    ends behind the last place where the curvature |X_tt . n| / |X_t|^2 is a tenth of the largest at
    that edge or more, at the span where that is furthest, at a tenth of t at most. A sharp or
    blunt edge has no zone on the sides, 0: there the edge is a line, or a face of its own.
    """
    u, t = np.linspace(0.0, 1.0, 41), graded(1601)
    t = t[t <= WIDEST]
    none = 0.0, 0.0
    return (
        _widths(surface, u, t) if surface.le == "round" else none,
        _widths(surface, u, 1.0 - t) if surface.te == "round" else none,
    )


def _widths(surface: BladeSurface, u: Vector, t: Vector) -> Widths:
    bends = [_curvature(surface, side, u, t) for side in SIDES]
    largest = np.max([k.max(axis=1) for k in bends], axis=0)
    suction, pressure = (_last(k >= ROUND * largest[:, None]) for k in bends)
    return float(abs(t[suction] - t[0])), float(abs(t[pressure] - t[0]))


def _last(bent: NDArray[np.bool_]) -> int:
    """Number of the place behind the last one that is bent at any span."""
    last = int(np.flatnonzero(bent.any(axis=0))[-1])
    return int(min(last + 1, bent.shape[1] - 1))


def _curvature(surface: BladeSurface, side: SideName, u: Vector, t: Vector) -> Array:
    """Normal curvature along the section, 1/mm, (nu, nt)."""
    X_t, X_tt = surface(side, u, t, 0, 1), surface(side, u, t, 0, 2)
    bend = np.abs(np.einsum("utx,utx->ut", X_tt, normals(surface, side, u, t)))
    return np.asarray(bend / np.einsum("utx,utx->ut", X_t, X_t))
