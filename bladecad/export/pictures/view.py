"""Where to stand to see a blade: from ahead of its leading edge, a little above, on either side."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from bladecad.arrays import Array, Points, Vector, seal
from bladecad.surface.blade import BladeSurface, SideName, normals

MARGIN: Final = 1.03
FORWARD, UPWARD = 0.7, 0.5  # towards the leading edge and the tip, beside 1 across the chord
PROBES: Final = np.linspace(0.1, 0.9, 9)


@final
@dataclass(frozen=True, eq=False)
class View:
    """A parallel view of a blade.

    rows   : (3, 3) float; unit vectors to the right, upwards, and towards the eye
    centre : (3,) float, mm, the middle of the picture
    size   : width and height of what is seen, mm
    """

    rows: Array
    centre: Vector
    size: tuple[float, float]

    def __post_init__(self) -> None:
        seal(self, rows=(3, 3), centre=(3,))

    def __call__(self, points: Points) -> Array:
        """Places in the picture, (k, 2), mm to the right of and above its lower left corner."""
        seen = (points - self.centre) @ self.rows[:2].T
        return np.asarray(seen + 0.5 * np.array(self.size))


def view_of(surface: BladeSurface, name: SideName, points: Points) -> View:
    """Look at one side of a blade, the tip upwards, as near as all the points can be seen."""
    corners = surface(name, np.array([0.0, 1.0]), np.array([0.0, 1.0]))
    up = _unit(corners[1].mean(axis=0) - corners[0].mean(axis=0))
    forward = _unit(corners[:, 0].mean(axis=0) - corners[:, 1].mean(axis=0))
    n = normals(surface, name, PROBES, PROBES).mean(axis=(0, 1))
    across = _unit(n - (n @ up) * up)
    return _framed(points, up, _unit(across + FORWARD * forward + UPWARD * up))


def _framed(points: Points, up: Vector, towards: Vector) -> View:
    right = _unit(np.cross(up, towards))
    rows = np.stack([right, np.cross(towards, right), towards])
    seen = points @ rows.T
    low, high = seen.min(axis=0), seen.max(axis=0)
    width, height = MARGIN * (high - low)[:2]
    return View(rows, 0.5 * (low + high) @ rows, (float(width), float(height)))


def _unit(v: Vector) -> Vector:
    return np.asarray(v / np.linalg.norm(v))
