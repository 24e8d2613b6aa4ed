"""How far the faces of a solid, or of a file, are from the sides they were made of."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Final, TypeAlias

import numpy as np

from bladecad.arrays import Array, Vector
from bladecad.brep.faces import sample_surface
from bladecad.brep.joints import Body
from bladecad.brep.kernel import kernel
from bladecad.surface.blade import SideName
from bladecad.surface.zones import Zone

Side: TypeAlias = Callable[[Vector, Vector], Array]  # u, t to points on their grid
PLACES: Final = 6  # in every span of knots


def astray(body: Body, zones: Mapping[str, Zone], sides: Mapping[SideName, Side]) -> float:
    """Largest distance of the kernel's faces from the sides, at equal u and t, mm.

    Parameters
    ----------
    body : Solid or CadFile
    zones : mapping
        Face name to what it covers, as in `Solid.zones`.
    sides : mapping
        "suction" and "pressure" to what evaluates them on a grid u x t: a patch of a loft, or a
        side of the surface itself.
    """
    with kernel("measuring the faces"):
        return max(_astray(body, name, zone, sides) for name, zone in zones.items())


def _astray(body: Body, name: str, zone: Zone, sides: Mapping[SideName, Side]) -> float:
    u, v = _inside(zone.patch.knots_u), _inside(zone.patch.knots_t)
    face, parts, largest = sample_surface(body.faces[name], u, v), len(zone.stretches), 0.0
    for k, stretch in enumerate(zone.stretches):
        here = (v * parts >= k) & (v * parts <= k + 1)
        t = stretch.first + (stretch.last - stretch.first) * (v[here] * parts - k)
        t = np.clip(t, 0.0, 1.0)
        away = np.linalg.norm(face[:, here] - sides[stretch.side](u, t), axis=-1)
        largest = max(largest, float(away.max()))
    return largest


def _inside(knots: Vector) -> Vector:
    breaks, share = np.unique(knots), np.linspace(0.0, 1.0, PLACES + 1)[:-1]
    return np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * share).ravel(), breaks[-1])
