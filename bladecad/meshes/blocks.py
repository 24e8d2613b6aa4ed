"""The blade as structured blocks: a grid of points on every face."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from bladecad.arrays import Array, Vector, seal
from bladecad.errors import ToleranceError
from bladecad.meshes.curvature import largest_curvature
from bladecad.meshes.sizing import Sizing, chordwise
from bladecad.surface.blade import BladeSurface
from bladecad.surface.loft import SIDES

LARGEST = 4_000_000  # points


@final
@dataclass(frozen=True, eq=False)
class Block:
    """One structured face.

    name      : that of the patch
    points    : (nj, ni, 3) float, mm; of the sides j runs from hub to tip and i from leading to
                trailing edge; of hub and tip j runs from suction to pressure side; of blunt edges i
    u, t      : (nj, ni) float
    curvature : (nj, ni) float, 1/mm, the principal curvature of larger size, convex positive; 0 on
                ruled faces
    """

    name: str
    points: Array
    u: Array
    t: Array
    curvature: Array

    def __post_init__(self) -> None:
        nj, ni, _ = np.shape(self.points)
        seal(self, points=(nj, ni, 3), u=(nj, ni), t=(nj, ni), curvature=(nj, ni))


def blade_blocks(surface: BladeSurface, sizing: Sizing) -> tuple[Block, ...]:
    """Lay a grid u x t on both sides, and one on hub, tip and blunt edges that meets it.

    Blocks that meet have the same points there, bit by bit. Hub and tip end in a line of equal
    points where an edge is round or sharp.

    Raises
    ------
    ToleranceError
        If a side would have more than four million points.
    """
    t = chordwise(surface, sizing)
    u = _rows(surface, t, sizing)
    if len(u) * len(t) > LARGEST:
        raise ToleranceError(
            f"a size of {sizing.size:g} mm gives {len(u) * len(t):,} points a side, "
            f"{LARGEST:,} at most; ask for a larger one"
        )
    S, P = _sides(surface, u, t)
    blocks = [_side(surface, i, X, u, t) for i, X in enumerate((S, P))]
    blocks += [_ruled("blade_hub", S[0], P[0], sizing.size, np.array([0.0]), t)]
    blocks += [_ruled("blade_tip", S[-1], P[-1], sizing.size, np.array([1.0]), t)]
    for name, column, kind in (("blade_le", 0, surface.le), ("blade_te", -1, surface.te)):
        if kind == "blunt":
            blocks += [_ruled(name, S[:, column], P[:, column], sizing.size, u, t[[column]])]
    return tuple(blocks)


def _rows(surface: BladeSurface, t: Vector, sizing: Sizing) -> Vector:
    """u with steps no longer than the size on any line t = const of either side."""
    u = np.linspace(0.0, 1.0, max(8 * len(surface.span), 65))
    step = np.max(
        [np.linalg.norm(np.diff(surface(s, u, t), axis=0), axis=2).max(axis=1) for s in SIDES],
        axis=0,
    )
    length = np.concatenate([[0.0], np.cumsum(step)])
    count = max(int(np.ceil(length[-1] / sizing.size)), 2)
    places = np.interp(np.linspace(0.0, length[-1], count + 1), length, u)
    places[[0, -1]] = 0.0, 1.0
    return places


def _sides(surface: BladeSurface, u: Vector, t: Vector) -> tuple[Array, Array]:
    """Both grids; a round or sharp edge has the points of the suction side on both."""
    S, P = (surface(side, u, t) for side in SIDES)
    for column, kind in ((0, surface.le), (-1, surface.te)):
        if kind != "blunt":
            P[:, column] = S[:, column]
    return S, P


def _side(surface: BladeSurface, i: int, X: Array, u: Vector, t: Vector) -> Block:
    at_u, at_t = np.meshgrid(u, t, indexing="ij")
    bend = largest_curvature(surface, SIDES[i], at_u.ravel(), at_t.ravel())
    return Block(f"blade_{SIDES[i]}", X, at_u, at_t, bend.reshape(at_u.shape))


def _ruled(name: str, A: Array, B: Array, size: float, u: Vector, t: Vector) -> Block:
    """Rulings from A on the suction side to B on the pressure side."""
    gap = float(np.linalg.norm(B - A, axis=1).max())
    s = np.linspace(0.0, 1.0, max(int(np.ceil(gap / size)), 1) + 1)[:, None, None]
    X = (1.0 - s) * A + s * B
    shape = X.shape[:2]
    return Block(name, X, np.broadcast_to(u, shape), np.broadcast_to(t, shape), np.zeros(shape))
