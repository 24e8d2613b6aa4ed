"""How large triangles on a wall may be, by its bend along and round the axis."""

from __future__ import annotations

from typing import Final

import numpy as np

from bladecad.arrays import Vector
from bladecad.passage.walls import Wall

ROUND, ALONG = 3.0, 0.5  # a triangle h wide leaves a circle by h^2 / 6 r: half for that, half along
HALVES: Final = 6
GROWTH: Final = 0.3  # of the step, from mm to mm


def allowed(wall: Wall, *, size: float, chord_error: float) -> Vector:
    """Largest step at every place of the wall's table, mm, `size` at most.

    Notes
    -----
    Along the flow the distance of chords from the wall is taken as it is, not from its curvature:
    a wall printed to a tenth of a millimetre is bent at every point and yet nearly straight.
    """
    s, length, _ = wall.table
    even = np.linspace(0.0, length[-1], max(8 * int(length[-1] / size), 2000))
    zr = wall(np.interp(even, length, s))
    around = np.sqrt(ROUND * np.maximum(zr[:, 1], 1e-3 * size) * chord_error)
    along, step = np.full(len(even), float(size)), even[1]
    for k in range(HALVES):
        h = size / 2.0**k
        half = min(max(round(0.5 * h / step), 1), (len(even) - 1) // 2)
        padded = np.pad(zr, ((half, half), (0, 0)), mode="edge")
        sag = np.linalg.norm(zr - 0.5 * (padded[2 * half :] + padded[: -2 * half]), axis=1)
        sag[:half], sag[-half:] = sag[half], sag[-half - 1]
        along[sag > ALONG * chord_error] = 0.5 * h
        if half == 1:
            break
    rise = GROWTH * even
    along = np.minimum.accumulate(along - rise) + rise
    along = np.minimum.accumulate((along + rise)[::-1])[::-1] - rise
    return np.asarray(np.interp(length, even, np.minimum(along, around)))
