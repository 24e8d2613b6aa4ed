"""How far along the span a place is: by planes, cylinders or cones, and these laid flat."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal, final

import numpy as np

from bladecad.arrays import Array, Points, Vector, seal
from bladecad.errors import DataError

Kind = Literal["plane", "cylinder", "cone"]
UNIT = 1e-9  # a direction may miss the length 1 by so much


@final
@dataclass(frozen=True, eq=False)
class Height:
    """How far along the span a place is, mm: planes, or cylinders or cones about a machine axis.

    kind       : "plane", "cylinder" or "cone"
    axis       : (3,) float, unit; for planes the stacking axis from hub to tip, else the machine's
    origin     : (3,) float, mm, on the axis; planes are counted from it, it is the apex of cones
    half_angle : of the cones, the angle between axis and cone, radians; 0 else

    A height is the distance from the origin along the axis; from the axis; or from the cone through
    the origin, positive outside. `flat` lays planes, cylinders and cones flat for slicing.
    """

    kind: Kind
    axis: Vector
    origin: Vector
    half_angle: float = 0.0

    def __post_init__(self) -> None:
        seal(self, axis=(3,), origin=(3,))
        length = float(np.linalg.norm(self.axis))
        if abs(length - 1.0) > UNIT:
            raise DataError(f"the axis of the heights has length {length:.6g}, 1 is needed")
        if self.kind == "cone" and not 0.0 < abs(self.half_angle) < 0.49 * np.pi:
            raise DataError(
                f"a cone of half angle {np.degrees(self.half_angle):.3g} degrees; it must lie "
                "between 0 and 88, take planes or cylinders beyond"
            )

    def __call__(self, points: Points) -> Vector:
        """The height of every point, (k,), mm."""
        if self.kind == "plane":
            return np.asarray((points - self.origin) @ self.axis)
        along, radius, _ = self._polar(points)
        return np.asarray(np.cos(self._lean) * radius - np.sin(self._lean) * along)

    def flat(self, points: Points, radius: float, middle: float) -> Points:
        """Lay points flat: two coordinates across the span, and the height, (k, 3), mm.

        Parameters
        ----------
        points : (k, 3) float, mm
        radius, middle : float
            Of cylinders and cones: mm on which, and angle about which, they are rolled out.
        """
        if self.kind == "plane":
            return np.asarray((points - self.origin) @ self._rows.T)
        along, r, angle = self._polar(points)
        turned = np.mod(angle - middle + np.pi, 2.0 * np.pi) - np.pi
        slope = np.sin(self._lean) * r + np.cos(self._lean) * along
        height = np.cos(self._lean) * r - np.sin(self._lean) * along
        return np.stack([slope, radius * turned, height], axis=1)

    def round(self, flat: Points, radius: float, middle: float) -> Points:
        """Undo `flat`."""
        if self.kind == "plane":
            return np.asarray(flat @ self._rows + self.origin)
        slope, turned, height = flat.T
        along = np.cos(self._lean) * slope - np.sin(self._lean) * height
        r = np.sin(self._lean) * slope + np.cos(self._lean) * height
        angle = turned / radius + middle
        polar = np.stack([r * np.cos(angle), r * np.sin(angle), along], axis=1)
        return np.asarray(polar @ self._rows + self.origin)

    def middle(self, points: Points) -> tuple[float, float]:
        """Mean radius and polar angle of points, for `flat`."""
        _, r, angle = self._polar(points)
        return float(r.mean()), float(np.angle(np.exp(1j * angle).mean()))

    @property
    def _lean(self) -> float:
        return self.half_angle if self.kind == "cone" else 0.0

    @cached_property
    def _rows(self) -> Array:
        """Rows: two directions across the axis, and the axis; right-handed."""
        least = np.eye(3)[np.abs(self.axis).argmin()]
        first = least - (least @ self.axis) * self.axis
        first /= np.linalg.norm(first)
        return np.stack([first, np.cross(self.axis, first), self.axis])

    def _polar(self, points: Points) -> tuple[Vector, Vector, Vector]:
        x, y, along = ((points - self.origin) @ self._rows.T).T
        return along, np.hypot(x, y), np.arctan2(y, x)


def planes(axis: Vector) -> Height:
    """Heights along an axis, counted from the origin of the scan."""
    a = np.asarray(axis, dtype=np.float64)
    return Height("plane", a / np.linalg.norm(a), np.zeros(3))
