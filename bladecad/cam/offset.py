"""The true offset of a blade, a machining allowance: everywhere the same distance from it."""

from __future__ import annotations

from typing import Final

import numpy as np

from bladecad.arrays import Points, Vector
from bladecad.cam.fitted import fitted
from bladecad.cam.parallel import Parallel
from bladecad.cam.places import places
from bladecad.cam.room import check_room
from bladecad.deviation.nominal import nominal_of
from bladecad.deviation.skin import Skin, search, skin_of
from bladecad.deviation.squares import cut, joined
from bladecad.errors import GeometryError
from bladecad.surface.blade import BladeSurface
from bladecad.surface.loft import Loft, first_breaks
from bladecad.surface.patch import SplinePatch

BETWEEN: Final = np.linspace(0.0, 1.0, 4)[:-1]


def offset_loft(surface: BladeSurface, distance: float, *, tolerance: float = 5e-4) -> Loft:
    """Offset both sides of a blade along their normals, as two B-spline patches.

    Parameters
    ----------
    surface : BladeSurface
    distance : float
        mm, positive out of the metal. Hub and tip get none: their rims move with the sides.
    tolerance : float
        mm, of the distance.

    Returns
    -------
    Loft
        Patches on the same knots, of one curve and one tangent at a round edge. `error` is the
        largest | distance - d |, mm, measured by nearest points, from the offset to the blade and
        from the blade to the offset.

    Raises
    ------
    ToleranceError
        If the distance is zero or no number.
    GeometryError
        If the offset would cross itself, an edge is sharp, or the tolerance is not met.

    Notes
    -----
    O(u,t) = S + d n, with O_t and O_tt in closed form at the edges: where S is continuous in
    curvature across an edge, so is O (do Carmo, section 3-5, exercise 11: k -> k / (1 + d k)).
    """
    check_room(surface, distance)
    formula = Parallel(surface, distance).derivatives
    round_edges = (surface.le == "round", surface.te == "round")
    u = np.unique(surface.knots[0])
    patches = fitted(formula, u, first_breaks(surface), tolerance=tolerance, joined=round_edges)
    error = _error(surface, patches, abs(distance))
    if error > tolerance:
        raise GeometryError(
            f"the offset is {1e3 * error:.3g} um off, {1e3 * tolerance:.3g} um are allowed; ask "
            "for a larger tolerance"
        )
    return Loft(*patches, error)


def _error(
    surface: BladeSurface, patches: tuple[SplinePatch, SplinePatch], distance: float
) -> float:
    """Largest deviation of the distance, both ways, mm."""
    there = np.concatenate([_dense(patch) for patch in patches])
    back = places(surface).points
    found = [(nominal_of(surface).sides, there), (_skin(patches), back)]
    return max(float(np.abs(np.abs(search(*f).distance) - distance).max()) for f in found)


def _dense(patch: SplinePatch) -> Points:
    """Three by three points in every cell of the knots, and the borders."""
    return patch(_inside(patch.knots_u), _inside(patch.knots_t)).reshape(-1, 3)


def _inside(knots: Vector) -> Vector:
    breaks = np.unique(knots)
    return np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * BETWEEN).ravel(), 1.0)


def _skin(patches: tuple[SplinePatch, SplinePatch]) -> Skin:
    """Squares of both patches; which way is out does not matter for how far it is."""
    return skin_of(
        joined(
            [
                cut(patch, np.unique(patch.knots_u), np.unique(patch.knots_t), face=k, sign=1.0)
                for k, patch in enumerate(patches)
            ]
        )
    )
