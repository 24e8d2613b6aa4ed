"""What the sections say about the surface between them: each one left out in turn."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from bladecad.arrays import Vector
from bladecad.fit.sidefit import SideFit
from bladecad.surface.blade import BladeSurface, normals
from bladecad.surface.loft import SIDES, graded


def leave_one_out(surface: BladeSurface) -> Vector:
    """Distance of each section from the surface that is blended without it, (m,) mm.

    Normal to the surface, largest over both sides; NaN for the sections at hub and tip, which
    cannot be left out. An honest bound of what may stand between two sections: the gap bridged
    here is twice as wide.
    """
    t = graded(201)
    found = np.full(len(surface.span), np.nan)
    for i in range(1, len(surface.span) - 1):
        without = _without(surface, i)
        u = surface.span[i : i + 1]
        away = [
            np.einsum(
                "utx,utx->ut",
                without(s, u, t) - surface(s, u, t),
                normals(surface, s, u, t),
            )
            for s in SIDES
        ]
        found[i] = np.abs(away).max()
    return found


def _without(surface: BladeSurface, i: int) -> BladeSurface:
    keep = np.arange(len(surface.span)) != i
    return replace(
        surface,
        span=surface.span[keep],
        suction=_kept(surface.suction, keep),
        pressure=_kept(surface.pressure, keep),
    )


def _kept(side: SideFit, keep: Vector) -> SideFit:
    bases = side.bases
    if len(bases) > 1:
        bases = tuple(b for b, k in zip(bases, keep, strict=True) if k)
    return SideFit(bases, side.coefficients[keep])
