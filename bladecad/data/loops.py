"""Points of a file become loops: repeated ends dropped, two sides joined, edge tags obeyed."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from bladecad.arrays import Array, Points
from bladecad.data.sections import Arc, Section
from bladecad.errors import DataError

REPEATED = 1e-9  # of the size: the same point, printed twice
SHARED = 1e-6  # of the size: the same edge point, computed once for each side
SHARED_STEP = 0.02  # of the first step along the side: too close to be an edge face
BLUNT = math.radians(45)  # six points round an edge, the coarsest met, turn by 36 degrees each


def loop(name: str, points: ArrayLike, tags: Mapping[int, str] | None = None) -> Section:
    """Return a section from points round the airfoil, the first perhaps repeated at the end.

    Parameters
    ----------
    points : (n, 3) float
    tags : mapping of point index to "le", "le1", "le2", "te", "te1", "te2"
    """
    rows = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    closed = len(rows) > 1 and _apart(rows[0], rows[-1]) <= REPEATED * size(rows)
    rows = rows[:-1] if closed else rows
    le, te = (_corners(tags or {}, edge, len(rows)) for edge in ("le", "te"))
    return Section(name, rows, closed=closed, le=le, te=te)


def two_sides(name: str, first: Points, second: Points, *, suction: Arc | None = None) -> Section:
    """Return a section from its two sides, each from the leading to the trailing edge.

    The loop runs along `first` to the trailing edge and back along `second`. Ends that meet become
    one edge point; ends joined by a face that both sides turn into sharply are a blunt edge.
    """
    if len(first) < 2 or len(second) < 2:
        raise DataError(
            f'section "{name}": sides of {len(first)} and {len(second)} points, '
            "2 are needed on each; complete the section"
        )
    if _opposed(first, second):
        second = second[::-1]
    le_shared, te_shared = _meet(first, second), _meet(first[::-1], second[::-1])
    points = np.vstack([first, second[::-1][te_shared : len(second) - le_shared]])
    le_blunt = not le_shared and _is_blunt(first, second)
    te_blunt = not te_shared and _is_blunt(first[::-1], second[::-1])
    k = len(first) - 1
    return Section(
        name,
        points,
        closed=not le_blunt,
        le=(len(points) - 1, 0) if le_blunt else (0,),
        te=(k, k + 1) if te_blunt else (k,),
        suction=suction,
    )


def arcs(section: Section) -> tuple[Points, Points] | None:
    """Return the two sides, from the leading edge; None where an edge is not said.

    The first runs in loop order from the leading edge, the second against it.
    """
    if not section.le or not section.te:
        return None
    first = _walk(section.points, section.le[-1], section.te[0])
    second = _walk(section.points, section.te[-1], section.le[0])
    return first, second[::-1]


def edge_tags(section: Section) -> dict[int, str]:
    """Return the tags le1, le2, te1, te2 of a section's edge points."""
    edges = (("le", section.le), ("te", section.te))
    return {i: f"{edge}{k}" for edge, corners in edges for k, i in enumerate(corners, 1)}


def size(points: Array) -> float:
    """Return the diagonal of the box round the points."""
    return float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) else 0.0


def _walk(points: Points, start: int, stop: int) -> Points:
    steps = (stop - start) % len(points)
    return points[(start + np.arange(steps + 1)) % len(points)]


def _opposed(first: Points, second: Points) -> bool:
    along = _apart(first[0], second[0]) + _apart(first[-1], second[-1])
    return _apart(first[0], second[-1]) + _apart(first[-1], second[0]) < along


def _meet(first: Points, second: Points) -> bool:
    """Whether both sides start in the same point, to rounding or to a fraction of their steps."""
    step = min(_apart(first[0], first[1]), _apart(second[0], second[1]))
    near = max(SHARED * size(np.vstack([first, second])), SHARED_STEP * step)
    return _apart(first[0], second[0]) <= near


def _is_blunt(first: Points, second: Points) -> bool:
    """Whether both sides start at the corners of a face: each turns sharply into it."""
    face = second[0] - first[0]
    return (
        _angle(face, first[0] - first[1]) > BLUNT and _angle(-face, second[0] - second[1]) > BLUNT
    )


def _angle(a: Array, b: Array) -> float:
    cosine = np.dot(a, b) / (np.linalg.norm(a) * np.linalg.norm(b) or 1.0)
    return float(np.arccos(np.clip(cosine, -1.0, 1.0)))


def _corners(tags: Mapping[int, str], edge: str, n: int) -> tuple[int, ...]:
    found = sorted({i % n for i, tag in tags.items() if tag.startswith(edge)})
    if len(found) == 2 and found[1] - found[0] > n / 2:
        found.reverse()
    return tuple(found)


def _apart(a: Array, b: Array) -> float:
    return float(np.linalg.norm(a - b))
