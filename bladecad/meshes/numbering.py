"""The vertices of a blade mesh, line by line; lines that meet share their vertices."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TypeAlias, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Points, Vector
from bladecad.meshes.places import at_places
from bladecad.surface.blade import BladeSurface

Line: TypeAlias = NDArray[np.int64]  # (m,) vertex numbers in order


@final
@dataclass(frozen=True, eq=False)
class Numbering:
    """Vertices, and their numbers along the lines of every face.

    vertices          : (n, 3) float, mm
    u, t              : (n,) float
    s                 : (n,) float, along rulings: 0 on the suction side, 1 on the pressure side
    suction, pressure : line t = const from hub to tip, one for each t
    hub, tip          : ruling from suction to pressure side, one for each t; one vertex at an edge
    leading, trailing : of a blunt edge, ruling from suction to pressure side, one for each u
    """

    vertices: Points
    u: Vector
    t: Vector
    s: Vector
    suction: list[Line]
    pressure: list[Line]
    hub: list[Line]
    tip: list[Line]
    leading: list[Line]
    trailing: list[Line]


def number(surface: BladeSurface, t: Vector, rows: Sequence[Vector], size: float) -> Numbering:
    """Lay out the vertices of both sides, of hub and tip, and of blunt edges.

    t : (k,) float, the lines; rows : u on each of them; size : mm, largest step on rulings
    """
    sides, S, P = _sides(surface, t, rows)
    ends = [(np.array([a[i] for a in S]), np.array([b[i] for b in P])) for i in (0, -1)]
    cells = [_cells(sides[0], a, b, size) for a, b in ends]
    for column, kind in ((0, surface.le), (-1, surface.te)):
        if kind == "blunt":
            cells[0][column] = cells[1][column] = max(cells[0][column], cells[1][column])
    store = sides
    hub, store = _ruled(store, *ends[0], cells[0])
    tip, store = _ruled(store, *ends[1], cells[1])
    edges = []
    for column, kind in ((0, surface.le), (-1, surface.te)):
        lines: list[Line] = []
        if kind == "blunt":
            a, b = S[column][1:-1], P[column][1:-1]
            inner, store = _ruled(store, a, b, np.full(len(a), cells[0][column]))
            lines = [hub[column], *inner, tip[column]]
        edges.append(lines)
    return Numbering(*store, S, P, hub, tip, *edges)


Store: TypeAlias = tuple[Points, Vector, Vector, Vector]  # X, u, t, s


def _sides(
    surface: BladeSurface, t: Vector, rows: Sequence[Vector]
) -> tuple[Store, list[Line], list[Line]]:
    """Vertices of both sides; a line that the sides share is numbered once."""
    own = slice(0 if surface.le == "blunt" else 1, None if surface.te == "blunt" else -1)
    u, at = np.concatenate(rows), np.repeat(t, [len(r) for r in rows])
    v, beside = np.concatenate(rows[own]), np.repeat(t[own], [len(r) for r in rows[own]])
    S = _split(0, rows)
    P = list(S)
    P[own] = _split(len(u), rows[own])
    X = [at_places(surface, "suction", u, at), at_places(surface, "pressure", v, beside)]
    s = np.repeat([0.0, 1.0], [len(u), len(v)])
    store = np.concatenate(X), np.concatenate([u, v]), np.concatenate([at, beside]), s
    return store, S, P


def _split(first: int, rows: Sequence[Vector]) -> list[Line]:
    ends = first + np.cumsum([0, *(len(r) for r in rows)])
    return [np.arange(a, b) for a, b in pairwise(ends)]


def _cells(X: Points, a: Line, b: Line, size: float) -> Line:
    """Cells on every ruling, about as long as the border's steps beside it; none where a is b."""
    steps = 0.5 * sum(np.linalg.norm(np.diff(X[k], axis=0), axis=1) for k in (a, b))
    beside = 0.5 * (np.append(steps, steps[-1]) + np.insert(steps, 0, steps[0]))
    length = np.linalg.norm(X[b] - X[a], axis=1)
    cells = np.maximum(np.round(length / np.minimum(size, beside)), 1)
    return np.where(a == b, 0, cells).astype(int)


def _ruled(store: Store, a: Line, b: Line, cells: Line) -> tuple[list[Line], Store]:
    """Rulings from every vertex of a to that of b, with new vertices between."""
    X, u, t, s = store
    new = np.maximum(cells - 1, 0)
    which = np.repeat(np.arange(len(a)), new)
    nth = np.arange(len(which)) - np.repeat(np.cumsum(new) - new, new) + 1
    share = nth / cells[which]
    between = X[a[which]] + share[:, None] * (X[b[which]] - X[a[which]])
    inner = _split(len(X), [np.empty(n) for n in new])
    lines = [
        np.concatenate([[i], k, [j]]) if i != j else np.array([i])
        for i, j, k in zip(a, b, inner, strict=True)
    ]
    u, t = (np.concatenate([known, known[a[which]]]) for known in (u, t))
    return lines, (np.concatenate([X, between]), u, t, np.concatenate([s, share]))
