"""One section as smooth lines between its edges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, final

import numpy as np

from bladecad.arrays import Array, Mask, Points, Vector
from bladecad.curves.corners import corners
from bladecad.curves.develop import Flat, develop
from bladecad.curves.line import Line
from bladecad.curves.medial import inscribed, tangents
from bladecad.data.sections import Section
from bladecad.errors import DataError

EdgeKind = Literal["round", "sharp", "blunt"]
DENSE = 6  # samples a gap on which circles are inscribed
PARALLEL = np.radians(140.0)  # opening of a circle that touches both sides, not one edge


@final
@dataclass(frozen=True, eq=False)
class Track:
    """A stretch of a line, run from one edge of the section to the other.

    line       : the line it lies on
    start, end : arc lengths on that line, mm; end < start runs against it
    """

    line: Line
    start: float
    end: float

    @property
    def length(self) -> float:
        """Arc length, mm."""
        return abs(self.end - self.start)

    def __call__(self, fraction: Vector, order: int = 0) -> Array:
        """Point, tangent or curvature vector at a fraction of the arc length, (k, 3)."""
        values = self.line(self.start + np.asarray(fraction) * (self.end - self.start), order)
        return -values if order == 1 and self.end < self.start else values

    def reversed(self) -> Track:
        """Return the same stretch run the other way."""
        return Track(self.line, self.end, self.start)

    def fractions(self) -> Vector:
        """Where the measured points lie on the stretch, (k,), rising, from 0 to 1 at most."""
        s = self.line.stations[:-1] if self.line.closed else self.line.stations
        around = np.array([-1.0, 0.0, 1.0]) if self.line.closed else np.zeros(1)
        places = (s[:, None] + self.line.length * around).ravel()
        f = (places - self.start) / (self.end - self.start)
        slack = 1e-9
        return np.sort(np.clip(f[(f >= -slack) & (f <= 1 + slack)], 0.0, 1.0))


@final
@dataclass(frozen=True, eq=False)
class Outline:
    """One section broken at its two edges; which edge leads is not decided here.

    sides : two tracks, both from edge 0 to edge 1; the first runs in loop order
    kinds : of edge 0 and of edge 1
    flat  : the measured points laid flat
    """

    section: Section
    sides: tuple[Track, Track]
    kinds: tuple[EdgeKind, EdgeKind]
    flat: Flat

    def turned(self) -> Outline:
        """Return the same outline with edge 0 and edge 1 exchanged."""
        first, second = self.sides
        swapped = (second.reversed(), first.reversed())
        return Outline(self.section, swapped, (self.kinds[1], self.kinds[0]), self.flat)


def trace(
    section: Section,
    axis: int,
    *,
    keep: Mask | None = None,
    find: bool = False,
    smooth: bool = False,
) -> Outline:
    """Break a section at its edges: those the file names, else those its shape shows.

    Parameters
    ----------
    section : Section
    axis : {0, 1, 2}
        Column of the machine axis.
    keep : (n,) bool, optional
        Points to use; the others were set aside as misprints.
    find : bool
        Look for round edges by shape even where the file names a point.
    smooth : bool
        Take every edge as round that the file does not call cut off.
    """
    flat = develop(section.points, axis)
    keep = np.ones(len(section.points), bool) if keep is None else keep
    loop = flat.points * _counter_clockwise(flat.points)
    breaks = _breaks(section, loop, smooth)
    named = [] if find else [e[0] for e in (section.le, section.te) if len(e) == 1]
    if len(breaks) == 2:
        return _two_lines(section, breaks, flat, keep)
    if len(breaks) == 1:
        return _one_line(section, breaks[0], named, flat, keep, axis)
    return _closed_line(section, named, flat, keep, axis)


def _counter_clockwise(flat: Points) -> Vector:
    x, y = flat.T
    area = np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)
    return np.array([1.0, 1.0 if area > 0 else -1.0])


def _breaks(section: Section, loop: Points, smooth: bool) -> list[tuple[int, ...]]:
    """Corners of edges that are not round, in loop order: those of the file first."""
    told = [edge for edge in (section.le, section.te) if len(edge) == 2]
    shown = [] if smooth else corners(loop)
    seen = [edge for edge in shown if not any(_near(edge, other) for other in told)]
    breaks = sorted(told + seen)
    if len(breaks) > 2:
        places = ", ".join(str(tuple(i + 1 for i in edge)) for edge in breaks)
        raise DataError(
            f'section "{section.name}": {len(breaks)} corners, at points {places}, two edges are '
            "expected; remove the points that do not belong to the outline"
        )
    return breaks


def _near(a: tuple[int, ...], b: tuple[int, ...]) -> bool:
    return any(min(b) - 2 <= i <= max(b) + 2 for i in a) or any(i in b for i in a)


def _run(section: Section, first: int, last: int, keep: Mask) -> Points:
    """Points from one index to another in loop order, ends included."""
    n = len(section.points)
    count = (last - first) % n or n
    index = (first + np.arange(count + 1)) % n
    chosen = keep[index]
    chosen[[0, -1]] = True
    return np.asarray(section.points[index[chosen]])


def _two_lines(section: Section, breaks: list[tuple[int, ...]], flat: Flat, keep: Mask) -> Outline:
    a, b = breaks
    first = Line(_run(section, a[-1], b[0], keep), closed=False)
    second = Line(_run(section, b[-1], a[0], keep), closed=False)
    sides = (Track(first, 0.0, first.length), Track(second, second.length, 0.0))
    return Outline(section, sides, (_kind(a), _kind(b)), flat)


def _one_line(
    section: Section, edge: tuple[int, ...], named: list[int], flat: Flat, keep: Mask, axis: int
) -> Outline:
    line = Line(_run(section, edge[-1], edge[0], keep), closed=False)
    named = [i for i in named if i not in edge]
    round_edge = _station(line, section, named[0]) if named else _other_edge(line, axis)
    sides = (Track(line, 0.0, round_edge), Track(line, line.length, round_edge))
    return Outline(section, sides, (_kind(edge), "round"), flat)


def _closed_line(section: Section, named: list[int], flat: Flat, keep: Mask, axis: int) -> Outline:
    line = Line(section.points[keep], closed=True)
    if len(named) == 2:
        a, b = (_station(line, section, i) for i in named)
    else:
        a, b = _round_edges(line, axis)
        if named:
            a = _station(line, section, named[0])
            b = max(
                (a, b), (a, _round_edges(line, axis)[0]), key=lambda e: float(_apart(line, *e))
            )[1]
    b = b if b > a else b + line.length
    sides = (Track(line, a, b), Track(line, a + line.length, b))
    return Outline(section, sides, ("round", "round"), flat)


def _kind(edge: tuple[int, ...]) -> EdgeKind:
    return "sharp" if len(edge) == 1 else "blunt"


def _station(line: Line, section: Section, index: int) -> float:
    """Arc length of a point of the file, or of the line point nearest to it if it was set aside."""
    away = np.linalg.norm(line.points - section.points[index], axis=1)
    return float(line.stations[int(away.argmin())])


def _apart(line: Line, a: Vector | float, b: Vector | float) -> Vector:
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
    loop = loop * _counter_clockwise(loop)
    medial = inscribed(loop, tangents(loop))
    partner = medial.partner.astype(int)
    through, back = s[partner], s[partner[partner]]
    arc = _apart(line, s, through)
    mutual = _apart(line, s, back) < 0.2 * arc
    both = (medial.opening > PARALLEL) & mutual
    arc, middle = np.abs(s - through)[both], 0.5 * (s + through)[both]
    if not line.closed:
        return arc, middle
    behind = arc > 0.5 * line.length
    middle = np.where(behind, (middle + 0.5 * line.length) % line.length, middle)
    return np.where(behind, line.length - arc, arc), middle


def _round_edges(line: Line, axis: int) -> tuple[float, float]:
    """Arc lengths of the two round edges of a closed line."""
    arc, middle = _pairs(line, axis)
    if len(arc) == 0:
        raise DataError("no circle touches two sides of the loop: this is no airfoil")
    first = _nose(line, arc, middle)
    far = _apart(line, first, middle) > 0.25 * line.length
    if not far.any():
        raise DataError("the loop has one edge only; it should have a leading and a trailing edge")
    return first, _nose(line, arc[far], middle[far])


def _other_edge(line: Line, axis: int) -> float:
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
