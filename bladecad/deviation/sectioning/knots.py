"""Where a section may bend: knots round the loop, dense at the edges, as many as points support."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from scipy.interpolate import BSpline

from bladecad.arrays import Array, Mask, Vector, seal
from bladecad.deviation.sectioning.station import Station, places
from bladecad.splines import clamped
from bladecad.surface.blade import SideName

DEGREE: Final = 3
TURN: Final = 0.4  # radians by which the outline turns between two knots
GROWTH: Final = 0.4  # of the knot step with the distance from where the outline turns more
BODY: Final = (8, 24)  # knot steps along a side, fewest and most
POINTS_A_STEP: Final = 12  # that ask for one more
ENOUGH: Final = 3  # points between two knots
ALONE: Final = 8  # points on an open stretch, else it has no knots


@final
@dataclass(frozen=True, eq=False)
class Round:
    """Cubic splines round a loop, continuous across its round edges.

    breaks : (n + 1,) float, mm of arc from the leading edge, the last one loop later
    te     : arc of the trailing edge if the spline is broken there, else None
    closed : whether it is continuous across the leading edge
    """

    breaks: Vector
    te: float | None
    closed: bool

    def __post_init__(self) -> None:
        seal(self, breaks=(None,))

    def __call__(self, arc: Vector) -> Array:
        """All splines at some places of the loop, (k, size)."""
        first, last = self.breaks[0], self.breaks[-1]
        again = [] if self.te is None else [self.te] * DEGREE
        loop = np.sort(np.concatenate([self.breaks[:-1], again]))
        if not self.closed:
            return _splines(clamped(np.append(loop, last), DEGREE), np.clip(arc, first, last))
        n, once = len(loop), last - first
        around = [loop[-DEGREE:] - once, loop, loop[: DEGREE + 1] + once]
        values = _splines(np.concatenate(around), first + np.mod(arc - first, once))
        values[:, :DEGREE] += values[:, n:]
        return values[:, :n]


def _splines(knots: Vector, x: Vector) -> Array:
    """All B-splines, (k, len(knots) - 4): only four are not zero at a place, which scipy uses."""
    return np.asarray(BSpline.design_matrix(x, knots, DEGREE).toarray())


def wished(station: Station, points: int) -> tuple[Vector, Vector]:
    """Return the knots that would follow a section well, along each side, edges included.

    They stand where the outline has turned by a share of a radian, and not much further apart
    beside that; `points` is how many were measured.
    """
    steps = float(np.clip(points / 2 / POINTS_A_STEP, *BODY))
    te, end = station.te_arc, station.perimeter
    there = _graded(station, "suction", 0.0, te, te / steps)
    return there, _graded(station, "pressure", te, end, (end - te) / steps)


def _graded(station: Station, name: SideName, first: float, last: float, body: float) -> Vector:
    """Knots from one edge to the other, in the order of the arc."""
    t = places()
    arc = station.arc_of(np.full(len(t), name == "suction"), t)
    n = station.flat_normal[station.side(name)]
    if name == "pressure":
        arc, n = arc[::-1], n[::-1]
    turn = np.arccos(np.clip(np.einsum("ix,ix->i", n[1:], n[:-1]), -1.0, 1.0))
    step = np.minimum(body, TURN * np.diff(arc) / np.maximum(turn, 1e-12))
    middle = 0.5 * (arc[1:] + arc[:-1])
    step = np.min(step + GROWTH * np.abs(middle[:, None] - middle), axis=1)
    mass = np.concatenate([[0.0], np.cumsum(np.diff(arc) / step)])
    count = max(int(np.ceil(mass[-1])), 2)
    knots = np.interp(np.linspace(0.0, mass[-1], count + 1), mass, arc)
    knots[0], knots[-1] = first, last
    return knots


def supported(
    sides: tuple[Vector, Vector], arc: Vector, *, open_te: bool, closed: bool
) -> Round | None:
    """Leave out knots until there are points between any two; None where there are too few.

    Parameters
    ----------
    sides : knots along each side
    arc   : (k,) float, of the points
    open_te, closed : whether it is broken at the trailing edge, and whole at the leading edge
    """
    arc = np.sort(arc)
    there, back = sides
    stretches = [there, back] if open_te else [np.concatenate([there, back[1:]])]
    parts = [_thinned(knots, arc) for knots in stretches]
    if min(_number(arc, part[0], part[-1]) for part in parts) < ALONE:
        return None
    breaks = np.concatenate([part[:-1] for part in parts] + [back[-1:]])
    if len(breaks) <= DEGREE + 1:
        return None
    return Round(breaks, float(there[-1]) if open_te else None, closed)


def _thinned(knots: Vector, arc: Vector) -> Vector:
    """Knots with enough points between any two, the first and the last kept."""
    kept = [knots[0]]
    for knot in knots[1:-1]:
        if _number(arc, kept[-1], knot) >= ENOUGH:
            kept.append(knot)
    while len(kept) > 1 and _number(arc, kept[-1], knots[-1]) < ENOUGH:
        kept.pop()
    return np.array([*kept, knots[-1]])


def _number(arc: Vector, first: float, last: float) -> int:
    return int(np.searchsorted(arc, last) - np.searchsorted(arc, first))


def reached(sides: tuple[Vector, Vector], arc: Vector, at: Vector) -> Mask:
    """Whether there are points about each place: between its knots, or before and behind them."""
    knots = np.concatenate([sides[0], sides[1][1:]])
    has = np.histogram(arc, knots)[0] > 0
    has |= np.roll(has, 1) & np.roll(has, -1)
    return np.asarray(has[np.clip(np.searchsorted(knots, at, "right") - 1, 0, len(has) - 1)])
