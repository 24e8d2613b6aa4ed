"""Strips of triangles between neighbouring lines that need not have as many points."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Final

import numpy as np

from bladecad.arrays import Points, Vector
from bladecad.surface.ruled import Triangles

DEEP: Final = 0.4  # of the length of a ruling; 0.5 is a semicircle's


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

    Rulings lie close together in a round edge, where the border runs along them: there the border
    itself, from side to side round the edge, is zipped to the first ruling as deep in as half as
    long.
    """
    first, last = _deep(vertices, rulings), len(rulings) - 1 - _deep(vertices, rulings[::-1])
    if first >= last:
        first, last = 0, len(rulings) - 1
    nose, tail = _round(rulings[: first + 1]), _round(rulings[last:][::-1])
    parts = [zipped(vertices, rulings[first : last + 1])]
    parts += [zipped(vertices, [nose, rulings[first]])] if first else []
    parts += [zipped(vertices, [rulings[last], tail])] if last < len(rulings) - 1 else []
    return np.concatenate(parts)


def _deep(vertices: Points, rulings: Sequence[Triangles]) -> int:
    """Number of the first ruling half as deep in as it is long; 0 where the end is no point."""
    if len(rulings[0]) > 1:
        return 0
    a, b = (vertices[[r[i] for r in rulings]] for i in (0, -1))
    depth = np.linalg.norm(0.5 * (a + b) - a[0], axis=1)
    return int(np.flatnonzero(depth[1:] >= DEEP * np.linalg.norm(b - a, axis=1)[1:])[0]) + 1


def _round(rulings: Sequence[Triangles]) -> Triangles:
    """The border from side to side round an edge: suction ends, the edge, pressure ends."""
    return np.array([*(r[0] for r in rulings[::-1]), *(r[-1] for r in rulings[1:])])


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
