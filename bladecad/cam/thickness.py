"""How thick a blade is: the balls that touch both of its sides from within."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from bladecad.arrays import Array, Vector, seal
from bladecad.cam.balls import balls
from bladecad.deviation.nearest.skin import Skin
from bladecad.surface.blade import BladeSurface, normals, principal_curvatures

EDGE: Final = 0.05  # of the side
T: Final = np.linspace(EDGE, 1.0 - EDGE, 91)


@final
@dataclass(frozen=True, eq=False)
class Thickness:
    """Diameters of inscribed balls that touch the suction side.

    u, t     : (m,) and (n,) float; of the places that are touched, edges (5 % of the side) left out
    diameter : (m, n) float, mm
    """

    u: Vector
    t: Vector
    diameter: Array

    def __post_init__(self) -> None:
        seal(self, u=(None,), t=(None,), diameter=(len(self.u), len(self.t)))

    @property
    def thinnest(self) -> tuple[float, float, float]:
        """Least thickness, mm, and its u and t."""
        return self._at(int(self.diameter.argmin()))

    @property
    def thickest(self) -> tuple[float, float, float]:
        """Largest thickness, mm, and its u and t."""
        return self._at(int(self.diameter.argmax()))

    @property
    def of_sections(self) -> Vector:
        """Largest thickness along the span, (m,), mm."""
        return np.asarray(self.diameter.max(axis=1))

    def _at(self, k: int) -> tuple[float, float, float]:
        i, j = np.unravel_index(k, self.diameter.shape)
        return float(self.diameter[i, j]), float(self.u[i]), float(self.t[j])


def thickness(surface: BladeSurface, skin: Skin, u: Vector) -> Thickness:
    """Measure the thickness of a blade between its edges.

    Parameters
    ----------
    surface : BladeSurface
    skin : Skin
        Its sides.
    u : (m,) float
    """
    X, n = surface("suction", u, T), normals(surface, "suction", u, T)
    size = float(np.linalg.norm(np.ptp(X.reshape(-1, 3), axis=0)))
    most = 1.0 / np.maximum(principal_curvatures(surface, "suction", u, T)[0], 1.0 / size)
    r = balls(skin, X.reshape(-1, 3), -n.reshape(-1, 3), most.ravel()).radius
    return Thickness(u, T, 2.0 * r.reshape(X.shape[:2]))
