"""The measured points of a section, also where they were not measured section by section."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

import numpy as np

from bladecad.arrays import Points
from bladecad.export.product import Product
from bladecad.surface.blade import BladeSurface

if TYPE_CHECKING:
    from bladecad.scans.judging.scanned import Scanned

SHOWN: Final = 500  # points of a scan that stand for a section
WIDEST: Final = 0.02  # of the span, from which they are taken, either way


def section_points(product: Product, i: int) -> Points:
    """Points of section i, (n, 3), mm; of a scan, those nearest to it, brought onto it."""
    if product.scanned is None:
        return product.sections.sections[i].points
    return _nearest(product.scanned, product.surface, float(product.lines.span[i]))


def _nearest(scanned: Scanned, surface: BladeSurface, u: float) -> Points:
    """Points near a section at their own t, as far from it as they are from the surface."""
    feet = scanned.whole.feet
    away = np.where(scanned.set_aside | feet.rim, np.inf, np.abs(feet.u - u))
    near = np.argpartition(away, min(SHOWN, len(away) - 1))[:SHOWN]
    near = near[away[near] <= WIDEST]
    on = surface("suction", np.array([u]), feet.t[near])[0]
    other = surface("pressure", np.array([u]), feet.t[near])[0]
    foot = np.where(feet.suction[near, None], on, other)
    return np.asarray(foot + feet.distance[near, None] * feet.normal[near])
