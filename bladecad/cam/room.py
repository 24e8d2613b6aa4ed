"""Whether there is room for an offset: where it would cross itself it is refused."""

from __future__ import annotations

from typing import Final

import numpy as np

from bladecad.cam.places import Places, places
from bladecad.deviation.nearest.skin import Skin, search
from bladecad.errors import GeometryError, ToleranceError
from bladecad.surface.blade import BladeSurface

MOST: Final = 0.9  # of a radius: what is left of it must still be a surface
NEARER: Final = 1e-6  # mm, by which a place that has another foot is nearer


def check_room(surface: BladeSurface, distance: float, skin: Skin) -> None:
    """Raise unless the parallel surface at some distance is one that does not cross itself.

    Where it bends more than the offset allows, and where the offset of one place comes nearer to
    another, the message names place and radius.

    Parameters
    ----------
    surface : BladeSurface
    distance : float
        mm, positive out of the metal.
    skin : Skin
        Sides of the blade.

    Raises
    ------
    ToleranceError
        If the distance is zero or no number.
    GeometryError
        If edges are sharp, sections are joined by creases, or there is no room.
    """
    if not np.isfinite(distance) or distance == 0.0:
        raise ToleranceError(f"an offset of {distance:g} mm is none; give mm, negative inwards")
    _check_smooth(surface)
    found = places(surface)
    _check_bend(found, distance)
    _check_others(skin, found, distance)


def _check_smooth(surface: BladeSurface) -> None:
    for name, kind in (("leading", surface.le), ("trailing", surface.te)):
        if kind == "sharp":
            raise GeometryError(
                f"the {name} edge is sharp: its sides have two normals there, and no offset of "
                "them meets; give the edge a radius first"
            )
    if surface.law == "linear" and len(surface.span) > 2:
        raise GeometryError(
            "sections are joined by creases (law linear), and offsets gape there; fit with "
            "--law spline"
        )


def _check_bend(found: Places, distance: float) -> None:
    """Inwards a convex radius shrinks to nothing, outwards a concave one."""
    k = found.k1 if distance < 0 else -found.k2
    worst = int(k.argmax())
    most = MOST / max(float(k.ravel()[worst]), 1e-12)
    if abs(distance) > most:
        way, bend = ("inwards", "convex") if distance < 0 else ("outwards", "concave")
        raise GeometryError(
            f"an offset of {abs(distance):.4g} mm {way} crosses itself: the {found.named(worst)} "
            f"has a {bend} radius of {most / MOST:.4g} mm; offset by {most:.4g} mm at most"
        )


def _check_others(skin: Skin, found: Places, distance: float) -> None:
    """A parallel place must have its own foot for the nearest of all."""
    off = search(skin, found.points + distance * found.directions)
    on_side = np.isin(skin.squares.face[off.item], (0, 1))  # faces of cut-off edges end the sides
    nearer = np.where(on_side, abs(distance) - np.abs(off.distance), 0.0)
    worst = int(nearer.argmax())
    if nearer[worst] > NEARER:
        way = "inwards" if distance < 0 else "outwards"
        p, n = found.points[worst], np.sign(distance) * found.directions[worst]
        away = off.foot[worst] - p  # the ball at p that meets the other side there
        raise GeometryError(
            f"an offset of {abs(distance):.4g} mm {way} crosses itself: over the "
            f"{found.named(worst)} there is room for {away @ away / (2.0 * away @ n):.4g} mm until "
            "it meets the other side; offset by less"
        )
