"""Strips of triangles between neighbouring lines that need not have as many points."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Final

import numpy as np

from bladecad.arrays import Points, Vector
from bladecad.meshes.named import NamedMesh
from bladecad.surface.ruled import Triangles

APART: Final = 0.7  # of a step of the border


def zipped(vertices: Points, lines: Sequence[Triangles]) -> Triangles:
    """Triangles between every line and the next, (k, 3).

    Parameters
    ----------
    vertices : (n, 3) float, mm
    lines : sequence of (m_j,) int
        Vertex numbers along each line, all in the same direction; a line may be a single vertex.

    Notes
    -----
    Every cell of a line, at its middle fraction of the line, makes one triangle with the vertex
    it faces: m_j + m_{j+1} - 2 triangles a strip, less where the lines share an end. Where both
    lines have as many cells these are quadrilaterals cut by one diagonal: of both diagonals the
    one with the better angles.
    """
    strips = [np.empty((0, 3), np.int64)]
    for a, b in pairwise(lines):
        both = (_strip(a, b, 0.0), _strip(a, b, 1e-9))
        strips.append(max(both, key=lambda strip: float(_sines(vertices, strip).mean())))
    return np.concatenate(strips)


def capped(vertices: Points, rulings: Sequence[Triangles]) -> Triangles:
    """Triangles of an end face between rulings from suction to pressure side, (k, 3).

    In a round edge the border runs across the chord, and rulings crowd: those that follow another
    closer than APART steps of the border are left out. There the shorter ruling, with the border
    on both sides of it, is zipped to the longer one.
    """
    kept = _kept(vertices, rulings)
    strips = []
    for i, j in pairwise(kept):
        between = rulings[i : j + 1]
        if j == i + 1:
            strips.append(zipped(vertices, between))
        elif _width(vertices, between[0]) < _width(vertices, between[-1]):
            strips.append(zipped(vertices, [_around(between), between[-1]]))
        else:
            strips.append(zipped(vertices, [between[0], _around(between[::-1])]))
    return np.concatenate(strips)


def _kept(vertices: Points, rulings: Sequence[Triangles]) -> list[int]:
    """Numbers of the rulings that are far enough apart; the first and the last always."""
    a, b = (vertices[[r[i] for r in rulings]] for i in (0, -1))
    middle, last = 0.5 * (a + b), len(rulings) - 1
    step = 0.5 * sum(np.linalg.norm(np.diff(x, axis=0), axis=1) for x in (a, b))
    kept = [0]
    for j in range(1, last):
        if np.linalg.norm(middle[j] - middle[kept[-1]]) >= APART * step[j - 1]:
            kept.append(j)
    if len(kept) > 1 and np.linalg.norm(middle[last] - middle[kept[-1]]) < 0.5 * APART * step[-1]:
        kept.pop()
    return [*kept, last]


def _around(rulings: Sequence[Triangles]) -> Triangles:
    """The first ruling with the border on both sides: from the last one's end to its other."""
    suction, pressure = [r[0] for r in rulings[:0:-1]], [r[-1] for r in rulings[1:]]
    return np.array([*suction, *rulings[0], *pressure])


def _width(vertices: Points, ruling: Triangles) -> float:
    return float(np.linalg.norm(vertices[ruling[-1]] - vertices[ruling[0]]))


def outward_mesh(mesh: NamedMesh) -> NamedMesh:
    """The same closed mesh, its triangles counter-clockwise from outside."""
    if mesh.volume >= 0.0:
        return mesh
    return NamedMesh(mesh.vertices, {name: k[:, ::-1] for name, k in mesh.patches.items()})


def _strip(a: Triangles, b: Triangles, late: float) -> Triangles:
    """One strip; cells of `a` that tie with a cell of `b` come first, or after it if late."""
    na, nb = len(a) - 1, len(b) - 1
    at = np.concatenate([_middles(na) + late, _middles(nb)])
    order = np.argsort(at, kind="stable")
    from_a = order < na
    i: Triangles = np.cumsum(from_a) - from_a
    k: Triangles = np.cumsum(~from_a) - ~from_a
    third = np.where(from_a, a[np.minimum(i + 1, na)], b[np.minimum(k + 1, nb)])
    strip = np.stack([a[i], b[k], third], axis=1)
    p, q, r = strip.T
    return np.asarray(strip[(p != q) & (q != r) & (r != p)])


def _middles(count: int) -> Vector:
    return (np.arange(count) + 0.5) / max(count, 1)


def _sines(vertices: Points, triangles: Triangles) -> Vector:
    """Sine of the smallest angle of each triangle: 2 area / product of the two longer sides."""
    X = vertices[triangles]
    sides = np.sort(np.linalg.norm(X - np.roll(X, 1, axis=1), axis=2), axis=1)
    area2 = np.linalg.norm(np.cross(X[:, 1] - X[:, 0], X[:, 2] - X[:, 0]), axis=1)
    return np.asarray(area2 / (sides[:, 1] * sides[:, 2]))
