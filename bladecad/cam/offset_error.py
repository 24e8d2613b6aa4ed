"""How far an offset is from the distance that was asked for, by nearest points, both ways."""

from __future__ import annotations

from typing import Final

import numpy as np

from bladecad.arrays import Points, Vector
from bladecad.cam.mitred import Mitred
from bladecad.deviation.nearest.skin import Skin, search, skin_of
from bladecad.deviation.nearest.squares import cut, joined
from bladecad.surface.blade import BladeSurface, SideName
from bladecad.surface.loft import SIDES, graded
from bladecad.surface.patch import SplinePatch
from bladecad.surface.volume import ruled

BETWEEN: Final = np.linspace(0.0, 1.0, 6)[:-1]
U, T = np.linspace(0.0, 1.0, 61), graded(401)
ACROSS: Final = np.linspace(0.0, 1.0, 5)


def distance_error(formula: Mitred, patches: tuple[SplinePatch, SplinePatch], skin: Skin) -> float:
    """Largest | distance - |d| |, from the offset to the blade and from the blade to it, mm.

    The corner of a cut-off edge has a mitre: places past it, of which no place of the other is at
    the distance, are left out. They lie on the outer one of the two. `skin` is that of the blade.
    """
    surface, d = formula.parallel.surface, formula.parallel.distance
    faces = [ruled(*patches, 1, end) for end in _cut_off(surface)]
    there = [_on_patch(formula, s, patch) for s, patch in zip(SIDES, patches, strict=True)]
    back = [_on_blade(formula, s) for s in SIDES]
    if d < 0:
        there += [patch(U, ACROSS).reshape(-1, 3) for patch in faces]
    else:
        back += [_on_face(surface, end) for end in _cut_off(surface)]
    found = [(skin, there), (_skin((*patches, *faces)), back)]
    return max(_largest(skin, np.concatenate(points), abs(d)) for skin, points in found)


def _cut_off(surface: BladeSurface) -> list[int]:
    """Columns of the edges that are cut off: 0, -1."""
    return [end for end, kind in ((0, surface.le), (-1, surface.te)) if kind == "blunt"]


def _on_patch(formula: Mitred, name: SideName, patch: SplinePatch) -> Points:
    """Five by five points in every cell of the knots that face the side, not its mitre."""
    u, t = _inside(patch.knots_u), _inside(patch.knots_t)
    s0, s1 = (s[:, None] for s in formula.limits(name, u))
    s = s0 + (s1 - s0) * t
    return np.asarray(patch(u, t)[(s >= 0.0) & (s <= 1.0)])


def _on_blade(formula: Mitred, name: SideName) -> Points:
    """Places of the side that the offset reaches."""
    s0, s1 = (s[:, None] for s in formula.limits(name, U))
    X = formula.parallel.surface(name, U, T)
    return np.asarray(X[(s0 <= T) & (s1 >= T)])


def _on_face(surface: BladeSurface, end: int) -> Points:
    """Places on the face of a cut-off edge."""
    S, P = (surface(s, U, np.array([float(-end)])) for s in SIDES)
    return np.asarray((1.0 - ACROSS[:, None]) * S + ACROSS[:, None] * P).reshape(-1, 3)


def _largest(skin: Skin, points: Points, distance: float) -> float:
    """Largest error; past hub and tip a face is taken to go straight on, as it is by `project`."""
    found = search(skin, points)
    u0, step = skin.squares.domain[found.item][:, :2].T
    u = u0 + step * found.place[:, 0]
    along = np.einsum("kx,kx->k", points - found.foot, found.normal)
    away = np.where((u <= 0.0) | (u >= 1.0), along, found.distance)
    return float(np.abs(np.abs(away) - distance).max())


def _inside(knots: Vector) -> Vector:
    breaks = np.unique(knots)
    return np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * BETWEEN).ravel(), 1.0)


def _skin(patches: tuple[SplinePatch, ...]) -> Skin:
    """Squares of all patches; which way is out does not matter for how far it is."""
    parts = [
        cut(patch, np.unique(patch.knots_u), np.unique(patch.knots_t), face=k, sign=1.0)
        for k, patch in enumerate(patches)
    ]
    return skin_of(joined(parts))
