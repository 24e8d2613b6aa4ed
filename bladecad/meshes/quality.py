"""How good triangles are: skewness, aspect, smallest angle, patch by patch."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import final

import numpy as np

from bladecad.arrays import Array, Points, Vector
from bladecad.meshes.named import NamedMesh
from bladecad.surface.ruled import Triangles


@final
@dataclass(frozen=True)
class Quality:
    """The triangles of a patch.

    triangles      : their number
    area           : mm^2, of all
    smallest_area  : mm^2, of one
    smallest_angle : degrees; 60 is best
    skewness       : largest and mean equiangle skewness,
                     max((theta_max - 60) / 120, (60 - theta_min) / 60); 0 is best, 1 degenerate
    mean_skewness
    aspect         : largest l_max (l_1 + l_2 + l_3) / (4 sqrt(3) area); 1 is best
    shortest, longest : mm, of the edges
    """

    triangles: int
    area: float
    smallest_area: float
    smallest_angle: float
    skewness: float
    mean_skewness: float
    aspect: float
    shortest: float
    longest: float


def quality(vertices: Points, triangles: Triangles) -> Quality:
    """Measure triangles.

    Notes
    -----
    The aspect is that of Knupp and others, The Verdict Geometric Quality Library, 2006; skewness
    is the equiangle skewness of Fluent and OpenFOAM's surface tools.
    """
    X = vertices[triangles]
    length, area = _lengths(X), _areas(X)
    angle = np.degrees(_angles(X))
    skewness = np.maximum((angle.max(axis=1) - 60.0) / 120.0, (60.0 - angle.min(axis=1)) / 60.0)
    with np.errstate(divide="ignore"):
        aspect = length.max(axis=1) * length.sum(axis=1) / (4.0 * np.sqrt(3.0) * area)
    return Quality(
        len(triangles), float(area.sum()), float(area.min()), float(angle.min()),
        float(skewness.max()), float(skewness.mean()), float(aspect.max()),
        float(length.min()), float(length.max()),
    )  # fmt: skip


def qualities(mesh: NamedMesh) -> Mapping[str, Quality]:
    """Measure every patch of a mesh."""
    return {name: quality(mesh.vertices, k) for name, k in mesh.patches.items()}


def _lengths(X: Array) -> Array:
    """Of the side opposite each corner, (k, 3)."""
    return np.asarray(np.linalg.norm(np.roll(X, -1, axis=1) - np.roll(X, -2, axis=1), axis=2))


def _areas(X: Array) -> Vector:
    return np.asarray(0.5 * np.linalg.norm(np.cross(X[:, 1] - X[:, 0], X[:, 2] - X[:, 0]), axis=1))


def _angles(X: Array) -> Array:
    """At each corner, radians, (k, 3); atan2 is exact for needles too."""
    p, q = np.roll(X, -1, axis=1) - X, np.roll(X, 1, axis=1) - X
    return np.asarray(
        np.arctan2(np.linalg.norm(np.cross(p, q), axis=2), np.einsum("kcx,kcx->kc", p, q))
    )
