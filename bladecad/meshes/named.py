"""Triangles in named patches that share their vertices."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import final

import numpy as np

from bladecad.arrays import Points, seal
from bladecad.surface.ruled import Triangles


@final
@dataclass(frozen=True, eq=False)
class NamedMesh:
    """A surface of triangles; patches that meet use the same vertices.

    vertices : (n, 3) float, mm, no two equal
    patches  : name to (k, 3) vertex numbers, counter-clockwise seen from outside the body that the
               mesh bounds: the metal of a blade, the fluid of a passage
    """

    vertices: Points
    patches: Mapping[str, Triangles]

    def __post_init__(self) -> None:
        seal(self, vertices=(None, 3))

    @property
    def triangles(self) -> Triangles:
        """All triangles, (k, 3)."""
        return np.concatenate(list(self.patches.values()))

    @property
    def volume(self) -> float:
        """Volume inside, mm^3; of an open surface it means nothing."""
        a, b, c = np.moveaxis(self.vertices[self.triangles] - self.vertices[0], 1, 0)
        return float(np.einsum("kx,kx->", a, np.cross(b, c)) / 6.0)

    @property
    def open_edges(self) -> int:
        """How many directed edges are not met by just one the other way; 0 where it is closed."""
        k, n = self.triangles, len(self.vertices)
        ahead = np.concatenate([k[:, i] * n + k[:, (i + 1) % 3] for i in range(3)])
        back = np.concatenate([k[:, (i + 1) % 3] * n + k[:, i] for i in range(3)])
        _, counts = np.unique(ahead, return_counts=True)
        return int(np.sum(counts - 1) + np.sum(~np.isin(ahead, back)))
