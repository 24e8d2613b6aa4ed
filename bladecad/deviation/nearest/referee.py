"""The referee: trimesh measures a sample against the triangulated blade."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Points, Vector
from bladecad.deviation.nearest.feet import Feet
from bladecad.errors import GeometryError
from bladecad.surface.ruled import Triangles
from bladecad.surface.triangulate import BladeMesh

SAMPLE = 1000
ROUNDING = 1e-6  # mm
SLACK = 1.05  # the chord error is taken at middles of edges and triangles, the largest lies beside
RIM = 1e-6  # of the span
CAPS = ("HUB", "TIP")  # the end sections lie on them: they would hide the distance from the sides


@final
@dataclass(frozen=True)
class Referee:
    """How far trimesh and the surface disagree.

    count        : points that trimesh measured
    disagreement : largest difference of the distances, mm
    bound        : what the triangulation allows, mm: about its chord error, for a point whose foot
                   lies on the border of hub or tip the error of that border
    """

    count: int
    disagreement: float
    bound: float


def confirm(mesh: BladeMesh, points: Points, feet: Feet) -> Referee:
    """Let `trimesh.proximity` measure a sample of the points, the largest distances among them.

    Raises
    ------
    GeometryError
        If it differs from the distance to the surface by more than the triangulation explains.
    """
    skin = np.concatenate([k for name, k in mesh.faces.items() if name not in CAPS])
    return confirm_on(mesh.vertices, skin, mesh.chord_error, points, feet, rim_error=mesh.rim_error)


def confirm_on(
    vertices: Points,
    triangles: Triangles,
    chord_error: float,
    points: Points,
    feet: Feet,
    *,
    rim_error: float = 0.0,
) -> Referee:
    """Do the same on any triangulation of the nominal, without hub and tip.

    Parameters
    ----------
    vertices, triangles : (n, 3) float, mm, and (m, 3) int
    chord_error, rim_error : float
        mm, largest distance of the triangles from the nominal, and of their border from its.
    points : (k, 3) float, mm
    feet : Feet
        What `project` found for them.
    """
    import trimesh

    sample = _sample(feet.distance)
    body = trimesh.Trimesh(vertices, triangles, process=False)
    measured = trimesh.proximity.closest_point(body, points[sample])[1]
    away = np.abs(measured - np.linalg.norm(points[sample] - feet.foot[sample], axis=1))
    on_rim = (feet.u[sample] <= RIM) | (feet.u[sample] >= 1.0 - RIM)
    bound = np.where(on_rim, max(chord_error, rim_error), chord_error)
    bound = SLACK * bound + ROUNDING
    k = int((away / bound).argmax())
    if away[k] > bound[k]:
        raise GeometryError(
            f"trimesh measures point {sample[k] + 1} {1e3 * away[k]:.3g} um otherwise than the "
            f"surface, {1e3 * bound[k]:.3g} um is allowed; ask for a smaller --chord-error"
        )
    return Referee(len(sample), float(away[k]), float(bound[k]))


def _sample(distance: Vector) -> NDArray[np.intp]:
    """Numbers of at most a thousand points: the fifty furthest, and evenly spaced others."""
    count = len(distance)
    if count <= SAMPLE:
        return np.arange(count)
    furthest = np.argsort(-np.abs(distance))[:50]
    even = np.linspace(0, count - 1, SAMPLE - 50).astype(int)
    return np.unique(np.concatenate([furthest, even]))
