"""The frame of the blade itself."""

from __future__ import annotations

from typing import Final

import numpy as np

from bladecad.arrays import Array, Points, Vector
from bladecad.surface.blade import BladeSurface
from bladecad.surface.loft import graded

T: Final = graded(601)
HUB: Final = np.array([0.0])


def blade_frame(surface: BladeSurface, axis: Vector) -> Array:
    """Return T_blade_scan, the rigid motion from the frame of the scan to that of the blade.

    z is the stacking axis from hub to tip, x the chord of the hub section from its leading to its
    trailing edge, as far as it is across z, and the origin the centroid of the hub section.

    Parameters
    ----------
    surface : BladeSurface
        In the frame of the scan.
    axis : (3,) float
        Stacking axis, hub to tip.

    Returns
    -------
    (4, 4) float
    """
    suction, pressure = (surface(side, HUB, T)[0] for side in ("suction", "pressure"))
    z = axis / np.linalg.norm(axis)
    chord = 0.5 * (suction[-1] + pressure[-1] - suction[0] - pressure[0])
    x = chord - (chord @ z) * z
    x = x / np.linalg.norm(x)
    rows = np.stack([x, np.cross(z, x), z])
    origin = _centroid(np.concatenate([suction, pressure[::-1]]) @ rows.T) @ rows
    move = np.eye(4)
    move[:3, :3], move[:3, 3] = rows, -rows @ origin
    return move


def _centroid(loop: Points) -> Vector:
    """Centroid of the area inside a loop, seen along z, at its mean height."""
    middle = loop.mean(axis=0)
    x, y, _ = (loop - middle).T
    cross = x * np.roll(y, -1) - np.roll(x, -1) * y
    place = [np.sum((c + np.roll(c, -1)) * cross) / (3.0 * np.sum(cross)) for c in (x, y)]
    return np.asarray(middle + np.array([*place, 0.0]))
