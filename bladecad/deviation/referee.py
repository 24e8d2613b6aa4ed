"""The referee: trimesh measures a sample against the triangulated blade."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Points, Vector
from bladecad.errors import GeometryError
from bladecad.surface.triangulate import BladeMesh

SAMPLE = 1000
ROUNDING = 1e-6  # mm
CAPS = ("HUB", "TIP")  # the end sections lie on them: they would hide the distance from the sides


@final
@dataclass(frozen=True)
class Referee:
    """How far trimesh and the surface disagree.

    count        : points that trimesh measured
    disagreement : largest difference of the distances, mm
    bound        : what the triangulation allows, its chord error, mm
    """

    count: int
    disagreement: float
    bound: float


def confirm(mesh: BladeMesh, points: Points, distance: Vector) -> Referee:
    """Let `trimesh.proximity` measure a sample of the points, the largest distances among them.

    Raises
    ------
    GeometryError
        If it differs from the distance to the surface by more than the chord error of the mesh.
    """
    import trimesh

    sample = _sample(distance)
    skin = [k for name, k in mesh.faces.items() if name not in CAPS]
    body = trimesh.Trimesh(mesh.vertices, np.concatenate(skin), process=False)
    measured = trimesh.proximity.closest_point(body, points[sample])[1]
    away = np.abs(measured - np.abs(distance[sample]))
    bound = mesh.chord_error + ROUNDING
    if away.max() > bound:
        worst = sample[int(away.argmax())]
        raise GeometryError(
            f"trimesh measures point {worst + 1} {1e3 * away.max():.3g} um otherwise than the "
            f"surface, {1e3 * bound:.3g} um is allowed; ask for a smaller --chord-error"
        )
    return Referee(len(sample), float(away.max()), bound)


def _sample(distance: Vector) -> NDArray[np.intp]:
    """Numbers of at most a thousand points: the fifty furthest, and evenly spaced others."""
    count = len(distance)
    if count <= SAMPLE:
        return np.arange(count)
    furthest = np.argsort(-np.abs(distance))[:50]
    even = np.linspace(0, count - 1, SAMPLE - 50).astype(int)
    return np.unique(np.concatenate([furthest, even]))
