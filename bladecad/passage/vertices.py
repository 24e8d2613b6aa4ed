"""Vertices that are numbered as they come, and shared by their numbers."""

from __future__ import annotations

from typing import final

import numpy as np

from bladecad.arrays import Array, Points
from bladecad.surface.ruled import Triangles


@final
class Vertices:
    """Points on the way to a mesh: `add` gives their numbers."""

    def __init__(self) -> None:
        self._blocks: list[Points] = []
        self._count = 0

    def add(self, points: Array) -> Triangles:
        """Number new points, (..., 3) mm; the numbers have their shape."""
        shape = points.shape[:-1]
        ids = self._count + np.arange(int(np.prod(shape))).reshape(shape)
        self._blocks.append(points.reshape(-1, 3))
        self._count += ids.size
        return ids

    @property
    def points(self) -> Points:
        """All points so far, (n, 3) mm."""
        return np.concatenate(self._blocks)
