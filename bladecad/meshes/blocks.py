"""The blade as structured blocks: a grid of points on every face."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from bladecad.arrays import Array, Vector, seal
from bladecad.errors import GeometryError
from bladecad.meshes.curvature import largest_curvature
from bladecad.meshes.named import NamedMesh
from bladecad.meshes.sizing import ALONG_T, Sizing, chordwise, even, largest_growth
from bladecad.meshes.strips import outward_mesh
from bladecad.surface.blade import BladeSurface, normals
from bladecad.surface.grid import measured, rim
from bladecad.surface.loft import SIDES
from bladecad.surface.ruled import Triangles

LARGEST: Final = 4_000_000  # points
MOST_ROUNDS: Final = 8


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


@final
@dataclass(frozen=True, eq=False)
class BladeBlocks:
    """All faces of a blade as blocks.

    blocks      : blade_suction, blade_pressure, blade_hub, blade_tip, and faces of blunt edges.
                  Blocks that meet have the same points there, bit by bit; hub and tip end in a
                  line of equal points where an edge is round or sharp
    chord_error : mm, largest distance of the sides' cells, cut by a diagonal, from the surface
    growth      : largest ratio of neighbouring steps along the chord, measured in t
    """

    blocks: tuple[Block, ...]
    chord_error: float
    growth: float


def blade_blocks(surface: BladeSurface, sizing: Sizing) -> BladeBlocks:
    """Lay a grid u x t on both sides, and one on hub, tip and blunt edges that meets it.

    The chord error is measured, and the grid refined until it is met.

    Raises
    ------
    GeometryError
        If a side would have more than four million points.
    """
    asked = sizing.chord_error
    for _ in range(MOST_ROUNDS):
        t = chordwise(surface, sizing)
        u = _rows(surface, t, sizing)
        if len(u) * len(t) > LARGEST:
            break
        error = max(*(measured(surface, side, u, t) for side in SIDES), rim(surface, t))
        if error <= asked:
            return BladeBlocks(_blocks(surface, u, t, sizing.size), error, largest_growth(t))
        sizing = replace(sizing, chord_error=sizing.chord_error * asked / error / 1.1)
    raise GeometryError(
        f"a chord error of {1e3 * asked:.3g} um at a size of {sizing.size:g} mm takes more than "
        f"{LARGEST:,} points a side; ask for a larger one"
    )


def triangles_of(blocks: Sequence[Block]) -> NamedMesh:
    """Cells of all blocks, each cut by a diagonal, with equal points once and no empty triangle."""
    points = np.concatenate([block.points.reshape(-1, 3) for block in blocks])
    distinct, which = np.unique(points, axis=0, return_inverse=True)
    patches, first = {}, 0
    for block in blocks:
        nj, ni, _ = block.points.shape
        ids = which[first : first + nj * ni].reshape(nj, ni)
        first += nj * ni
        sense = -1 if block.name in ("blade_pressure", "blade_hub", "blade_te") else 1
        patches[block.name] = _halves(ids)[:, ::sense]
    return outward_mesh(NamedMesh(distinct, patches))


def _halves(ids: Triangles) -> Triangles:
    a, b, c, d = (x.ravel() for x in (ids[:-1, :-1], ids[:-1, 1:], ids[1:, 1:], ids[1:, :-1]))
    both = np.concatenate([np.stack([a, b, c], 1), np.stack([a, c, d], 1)])
    i, j, k = both.T
    return np.asarray(both[(i != j) & (j != k) & (k != i)])


def _blocks(surface: BladeSurface, u: Vector, t: Vector, size: float) -> tuple[Block, ...]:
    S, P = _sides(surface, u, t)
    gap = np.linalg.norm(P[[0, -1]] - S[[0, -1]], axis=2).max()
    s = np.linspace(0.0, 1.0, max(int(np.ceil(gap / size)), 1) + 1)  # one for all: they meet
    blocks = [_side(surface, i, X, u, t) for i, X in enumerate((S, P))]
    blocks += [_ruled("blade_hub", S[0], P[0], s, np.array([0.0]), t)]
    blocks += [_ruled("blade_tip", S[-1], P[-1], s, np.array([1.0]), t)]
    for name, column, kind in (("blade_le", 0, surface.le), ("blade_te", -1, surface.te)):
        if kind == "blunt":
            blocks += [_ruled(name, S[:, column], P[:, column], s, u, t[[column]])]
    return tuple(blocks)


def _rows(surface: BladeSurface, t: Vector, sizing: Sizing) -> Vector:
    """u with steps within size and chord error on every line t = const of either side."""
    u = np.linspace(0.0, 1.0, max(8 * len(surface.span), 65))
    step, bend = np.zeros(len(u) - 1), 0.0
    for side in SIDES:
        away = np.linalg.norm(np.diff(surface(side, u, t), axis=0), axis=2).max(axis=1)
        step = np.maximum(step, away)
        X_uu, n = surface(side, u, t, 2, 0), normals(surface, side, u, t)
        bend = max(bend, float(np.abs(np.einsum("utx,utx->ut", X_uu, n)).max()))
    length = np.concatenate([[0.0], np.cumsum(step)])
    by_bend = np.sqrt(bend / (8.0 * (1.0 - ALONG_T) * sizing.chord_error))
    count = max(int(np.ceil(max(length[-1] / sizing.size, by_bend))), 2)
    return even(length, u, count)


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


def _ruled(name: str, A: Array, B: Array, s: Vector, u: Vector, t: Vector) -> Block:
    """Rulings from A on the suction side, s = 0, to B on the pressure side, s = 1."""
    X = A + s[:, None, None] * (B - A)  # where A is B, bit by bit A
    X[-1] = B
    shape = X.shape[:2]
    return Block(name, X, np.broadcast_to(u, shape), np.broadcast_to(t, shape), np.zeros(shape))
