"""The true offset of a blade, a machining allowance: everywhere the same distance from it."""

from __future__ import annotations

from typing import Final

import numpy as np

from bladecad.cam.fitted import fitted
from bladecad.cam.mitred import mitred
from bladecad.cam.offset_error import distance_error
from bladecad.cam.room import check_room
from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.errors import GeometryError
from bladecad.surface.blade import BladeSurface
from bladecad.surface.loft import Loft, first_breaks

FACES: Final = 2.0  # times the tolerance, for faces of cut-off edges


def offset_loft(surface: BladeSurface, distance: float, *, tolerance: float = 5e-4) -> Loft:
    """Offset both sides of a blade along their normals, as two B-spline patches.

    Parameters
    ----------
    surface : BladeSurface
    distance : float
        mm, positive out of the metal. Hub and tip get none: their rims move with the sides.
    tolerance : float
        mm, of the distance of the sides. The face of a cut-off edge is ruled between mitred
        corners; where it is twisted it may be off by twice as much.

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
    skin = nominal_of(surface).sides
    check_room(surface, distance, skin)
    formula = mitred(surface, distance)
    round_edges = (surface.le == "round", surface.te == "round")
    u = np.unique(surface.knots[0])
    patches = fitted(formula, u, first_breaks(surface), tolerance=tolerance, joined=round_edges)
    error = distance_error(formula, patches, skin)
    allowed = tolerance * (FACES if formula.cut_off else 1.0)
    if error > allowed:
        raise GeometryError(
            f"the offset is {1e3 * error:.3g} um off, {1e3 * allowed:.3g} um are allowed; ask for "
            "a larger tolerance"
        )
    return Loft(*patches, error)
