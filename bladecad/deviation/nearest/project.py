"""Foot points of any number of points on a nominal blade."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Mask, Points, Vector
from bladecad.deviation.nearest.feet import FACES, Feet
from bladecad.deviation.nearest.nominal import Nominal
from bladecad.deviation.nearest.skin import Found, Skin, search
from bladecad.deviation.nearest.triangles import TriangleSkin, search_triangles

OVERSHOOT = 1e-3  # of the blade's length: so far past hub or tip it is taken to go straight on


def project(nominal: Nominal, points: Points, *, caps: bool = False) -> Feet:
    """Find the nearest place of the nominal to every point, and the signed distance to it.

    Parameters
    ----------
    nominal : Nominal
    points : (k, 3) float, mm, finite
    caps : bool
        Close the blade at hub and tip by ruled faces; the distance is then that from a closed body.
        Otherwise only sides and faces of cut-off edges count: the points of an end section lie on
        the cap, which would hide their distance from the sides.

    Returns
    -------
    Feet
        Exact to the error of the squares, 1e-9 mm. A foot on the border at hub or tip is on the
        `rim` where the point stands beyond it by more than a thousandth of the length; nearer ones
        are measured along the normal, as if the blade went straight on.

    Notes
    -----
    The skin is cut into polynomial squares (`squares.cut`), each in a box along its own axes; a
    tree of boxes is searched, the nearer first, and Newton's method finds the foot on each square
    that can hold it. Work and memory of a thread do not grow with the number of points.
    """
    skin = nominal.closed if caps else nominal.sides
    on_blade = search(skin, points)
    u, t, suction, face = _coordinates(skin, on_blade)
    found = on_blade if nominal.other is None else _on_other(nominal.other, points)
    distance, rim = found.distance, np.zeros(len(points), bool)
    if not caps:
        held = np.flatnonzero((u <= 0.0) | (u >= 1.0))
        rim[held] = _past(on_blade, points, held) > OVERSHOOT * nominal.length
        held = held[~rim[held]]
        distance[held] = np.einsum("kx,kx->k", points[held] - found.foot[held], found.normal[held])
    return Feet(distance, found.foot, found.normal, face, suction, u, t, rim, found.unsettled)


def _coordinates(skin: Skin, found: Found) -> tuple[Vector, Vector, Mask, NDArray[np.int8]]:
    """Span, chordwise place, side and face of each foot; faces between the sides are halved."""
    face = skin.squares.face[found.item]
    a, b = found.place.T
    a0, a1, b0, b1 = skin.squares.domain[found.item].T
    u, t = a0 + a * a1, b0 + b * b1
    edge, cap = (face == 2) | (face == 3), face >= 4
    suction = np.where(cap, u < 0.5, np.where(edge, t < 0.5, face == 0))
    span = np.where(cap, np.where(face == FACES.index("TIP"), 1.0, 0.0), u)
    along = np.where(edge, np.where(face == FACES.index("TRAILING_EDGE"), 1.0, 0.0), t)
    return np.clip(span, 0.0, 1.0), np.clip(along, 0.0, 1.0), suction, face.astype(np.int8)


def _past(found: Found, points: Points, held: NDArray[np.intp]) -> Vector:
    """How far points stand past the border on which their foot is held, mm."""
    away = points[held] - found.foot[held]
    along = np.einsum("kx,kx->k", away, found.normal[held])
    return np.asarray(np.sqrt(np.maximum(np.einsum("kx,kx->k", away, away) - along**2, 0.0)))


def _on_other(skin: Skin | TriangleSkin, points: Points) -> Found:
    return search(skin, points) if isinstance(skin, Skin) else search_triangles(skin, points)
