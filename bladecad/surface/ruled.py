"""Ruled faces as triangles: caps at hub and tip, and the faces of cut-off edges."""

from __future__ import annotations

from itertools import pairwise
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Points

Triangles: TypeAlias = NDArray[np.int64]
MOST_ROWS = 64


def rows_needed(A: Points, B: Points, chord_error: float) -> int:
    """Rows into which the face between two lines is divided, 64 at most."""
    return int(np.clip(np.ceil(1.25 * twist(A, B) / chord_error), 1, MOST_ROWS))


def rule(
    vertices: Points, first: Triangles, second: Triangles, rows: int
) -> tuple[Triangles, Points, float]:
    """Rule a face between two lines of vertices, in rows where it is twisted.

    Parameters
    ----------
    vertices : (n, 3) float, mm
    first, second : (k,) int
        Numbers of the border vertices; where both have the same, the face ends in a point.
    rows : int

    Returns
    -------
    ids : (rows + 1, k) int
        Vertex numbers of the face as a grid, the borders first and last.
    vertices : (n + new, 3) float
        Two faces with equal rows that meet in a line get the same points there, bit by bit.
    error : float
        Largest distance of the triangles from the ruled face, mm.
    """
    A, B = vertices[first], vertices[second]
    X = A + np.linspace(0.0, 1.0, rows + 1)[:, None, None] * (B - A)
    inner = np.arange(len(vertices), len(vertices) + (rows - 1) * len(first))
    ids = np.concatenate([first[None], inner.reshape(rows - 1, len(first)), second[None]])
    ids[:, first == second] = first[first == second]
    error = max(twist(a, b) for a, b in pairwise(X))
    return ids, np.concatenate([vertices, X[1:-1].reshape(-1, 3)]), error


def twist(A: Array, B: Array) -> float:
    """Largest distance of the middle of a ruled quadrilateral from its diagonal, mm.

    The border lines are straight between their points here: how far those are from the curves is
    the chord error of the sides.
    """
    a, b, c, d = A[:-1], B[:-1], B[1:], A[1:]
    n = np.cross(c - a, b - d)
    size = np.linalg.norm(n, axis=1)
    height = np.abs(np.einsum("kx,kx->k", 0.25 * (b + d - a - c), n))
    return float(np.max(np.divide(height, size, out=np.zeros_like(size), where=size > 1e-12)))
