"""The zone and the band of any place of the blade."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Mask, Vector
from bladecad.deviation.inspecting.zones import zone_of
from bladecad.deviation.nearest.feet import Feet
from bladecad.tolerance import ZONES, Tolerances


def zone_at(tolerances: Tolerances, suction: Mask, u: Vector, t: Vector) -> NDArray[np.int64]:
    """Return the number in `ZONES` of the zone of every place of the sides, (k,)."""
    k = len(u)
    nowhere, face = np.zeros((k, 3)), np.where(suction, 0, 1).astype(np.int8)
    feet = Feet(np.zeros(k), nowhere, nowhere, face, suction, u, t, np.zeros(k, bool))
    return zone_of(feet, tolerances).astype(np.int64)


def bounds_at(tolerances: Tolerances, suction: Mask, u: Vector, t: Vector) -> Array:
    """Return lower and upper bound of the deviation at every place, (k, 2) mm."""
    bands = [tolerances.zones.get(zone) for zone in ZONES]
    bounds = [(band.lower, band.upper) if band else (np.nan, np.nan) for band in bands]
    return np.array(bounds)[zone_at(tolerances, suction, u, t)]
