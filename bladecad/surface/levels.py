"""Planes and cylinders as level surfaces, height(X) = const."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, final

import numpy as np

from bladecad.arrays import Array, Points, Vector, seal


class Level(Protocol):
    """A family of surfaces, height(X) = const.

    letter : of a height, in names of sections
    what   : one of them, as the user is told
    """

    @property
    def letter(self) -> str:
        """Of a height, in names of sections."""
        ...

    @property
    def what(self) -> str:
        """What one of them is called."""
        ...

    def height(self, X: Points) -> Vector:
        """The level of points, (..., 3) to (...), mm."""
        ...

    def gradient(self, X: Points) -> Array:
        """Its gradient, (..., 3), of length 1."""
        ...


@final
@dataclass(frozen=True, eq=False)
class Planes:
    """Planes square to a direction, through all heights X . d.

    direction : (3,) float, made a unit vector
    """

    direction: Vector

    def __post_init__(self) -> None:
        object.__setattr__(self, "direction", self.direction / np.linalg.norm(self.direction))
        seal(self, direction=(3,))

    @property
    def letter(self) -> str:
        """x, y or z of a coordinate plane, h of any other."""
        along = np.flatnonzero(self.direction == 1.0)
        return "xyz"[along[0]] if len(along) else "h"

    @property
    def what(self) -> str:
        """A plane, named by its normal."""
        if self.letter != "h":
            return f"plane {self.letter}"
        return f"plane square to {','.join(f'{d:.4g}' for d in self.direction)}, height"

    def height(self, X: Points) -> Vector:
        """X . d, mm."""
        return np.asarray(X @ self.direction)

    def gradient(self, X: Points) -> Array:
        """The direction d itself."""
        return np.broadcast_to(self.direction, np.shape(X))


@final
@dataclass(frozen=True)
class Cylinders:
    """Cylinders about a coordinate axis through the origin.

    axis : {0, 1, 2}, column of the machine axis
    """

    axis: int

    @property
    def letter(self) -> str:
        """A radius."""
        return "r"

    @property
    def what(self) -> str:
        """A cylinder, named by its radius."""
        return f"cylinder about {'xyz'[self.axis]}, r"

    def height(self, X: Points) -> Vector:
        """Radius, mm."""
        return np.asarray(np.linalg.norm(self._across(X), axis=-1))

    def gradient(self, X: Points) -> Array:
        """The radial direction."""
        across = self._across(X)
        return np.asarray(across / np.linalg.norm(across, axis=-1, keepdims=True))

    def _across(self, X: Points) -> Array:
        return np.where(np.arange(3) == self.axis, 0.0, X)
