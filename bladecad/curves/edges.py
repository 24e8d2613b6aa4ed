"""Where the camber line meets the outline: the round edges of a line, by inscribed circles."""

from __future__ import annotations

import numpy as np

from bladecad.arrays import Vector
from bladecad.curves.develop import develop
from bladecad.curves.line import Line
from bladecad.curves.medial import counter_clockwise, inscribed, tangents
from bladecad.errors import DataError

DENSE = 6  # samples a gap on which circles are inscribed
PARALLEL = np.radians(140.0)  # opening of a circle that touches both sides, not one edge


def apart(line: Line, a: Vector | float, b: Vector | float) -> Vector:
    """Arc length between two places, the shorter way round on a closed line, mm."""
    away = np.abs(np.asarray(a) - b)
    return np.minimum(away, line.length - away) if line.closed else away


def _pairs(line: Line, axis: int) -> tuple[Vector, Vector]:
    """Arc between the two touching points of each inscribed circle, and its middle.

    The shorter way round, except on an open line, where the way round is along the line.
    """
    s = line.densified(DENSE)
    dense = line(s)
    if np.array_equal(dense[0], dense[-1]):  # a sharp edge: both sides end in its point
        s, dense = s[:-1], dense[:-1]
    loop = develop(dense, axis).points
    loop = loop * counter_clockwise(loop)
    medial = inscribed(loop, tangents(loop))
    partner = medial.partner.astype(int)
    through, back = s[partner], s[partner[partner]]
    arc = apart(line, s, through)
    mutual = apart(line, s, back) < 0.2 * arc
    both = (medial.opening > PARALLEL) & mutual
    arc, middle = np.abs(s - through)[both], 0.5 * (s + through)[both]
    if not line.closed:
        return arc, middle
    behind = arc > 0.5 * line.length
    middle = np.where(behind, (middle + 0.5 * line.length) % line.length, middle)
    return np.where(behind, line.length - arc, arc), middle


def round_edges(line: Line, axis: int) -> tuple[float, float]:
    """Arc lengths of the two round edges of a closed line."""
    arc, middle = _pairs(line, axis)
    if len(arc) == 0:
        raise DataError("no circle touches two sides of the loop: this is no airfoil")
    first = _nose(line, arc, middle)
    far = apart(line, first, middle) > 0.25 * line.length
    if not far.any():
        raise DataError("the loop has one edge only; it should have a leading and a trailing edge")
    return first, _nose(line, arc[far], middle[far])


def other_edge(line: Line, axis: int) -> float:
    """Arc length of the round edge of a line that is open at its other edge."""
    arc, middle = _pairs(line, axis)
    inside = (middle > 0.2 * line.length) & (middle < 0.8 * line.length)
    return _nose(line, arc[inside], middle[inside])


def _nose(line: Line, arc: Vector, middle: Vector) -> float:
    """Where the camber line meets the outline: midway between the smallest pairs of touches."""
    start = middle[arc.argmin()]
    shift = middle - start
    if line.closed:
        shift = (shift + 0.5 * line.length) % line.length - 0.5 * line.length
    smallest = (arc <= 1.5 * arc.min()) & (np.abs(shift) < 0.1 * line.length)
    return float(start + np.median(shift[smallest]))
