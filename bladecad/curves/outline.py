"""One section as smooth lines between its edges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, final

import numpy as np

from bladecad.arrays import Array, Mask, Points, Vector
from bladecad.curves.corners import corners
from bladecad.curves.develop import Flat, develop
from bladecad.curves.edges import apart, other_edge, round_edges
from bladecad.curves.line import Line
from bladecad.curves.medial import counter_clockwise
from bladecad.data.sections import Section
from bladecad.errors import DataError

EdgeKind = Literal["round", "sharp", "blunt"]


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
    loop = flat.points * counter_clockwise(flat.points)
    breaks = _breaks(section, loop, smooth)
    named = [] if find else [e[0] for e in (section.le, section.te) if len(e) == 1]
    if len(breaks) == 2:
        return _two_lines(section, breaks, flat, keep)
    if len(breaks) == 1:
        return _one_line(section, breaks[0], named, flat, keep, axis)
    return _closed_line(section, named, flat, keep, axis)


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
    round_edge = _station(line, section, named[0]) if named else other_edge(line, axis)
    sides = (Track(line, 0.0, round_edge), Track(line, line.length, round_edge))
    return Outline(section, sides, (_kind(edge), "round"), flat)


def _closed_line(section: Section, named: list[int], flat: Flat, keep: Mask, axis: int) -> Outline:
    line = Line(section.points[keep], closed=True)
    if len(named) == 2:
        a, b = (_station(line, section, i) for i in named)
    else:
        a, b = round_edges(line, axis)
        if named:
            a = _station(line, section, named[0])
            b = max((a, b), (a, round_edges(line, axis)[0]), key=lambda e: float(apart(line, *e)))[
                1
            ]
    b = b if b > a else b + line.length
    sides = (Track(line, a, b), Track(line, a + line.length, b))
    return Outline(section, sides, ("round", "round"), flat)


def _kind(edge: tuple[int, ...]) -> EdgeKind:
    return "sharp" if len(edge) == 1 else "blunt"


def _station(line: Line, section: Section, index: int) -> float:
    """Arc length of a point of the file, or of the line point nearest to it if it was set aside."""
    away = np.linalg.norm(line.points - section.points[index], axis=1)
    return float(line.stations[int(away.argmin())])
