"""Where a section may bend: knots round the loop, dense at the edges, as many as points support."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from bladecad.arrays import Array, Mask, Vector, seal
from bladecad.splines import basis, clamped

DEGREE: Final = 3
AT_EDGE = 0.7  # of the edge radius: knot step there
GROWTH = 0.6  # of the knot step with the distance from the edge
BODY = (8, 24)  # knot steps along a side, fewest and most
POINTS_A_STEP = 12  # that ask for one more
ENOUGH = 3  # points between two knots
ALONE = 8  # points on an open stretch, else it has no knots


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
            return basis(clamped(np.append(loop, last), DEGREE), DEGREE, np.clip(arc, first, last))
        n, once = len(loop), last - first
        around = [loop[-DEGREE:] - once, loop, loop[: DEGREE + 1] + once]
        values = basis(np.concatenate(around), DEGREE, first + np.mod(arc - first, once))
        values[:, :DEGREE] += values[:, n:]
        return values[:, :n]


def wished(
    perimeter: float, te: float, radii: tuple[float, float], points: int
) -> tuple[Vector, Vector]:
    """Return the knots that would follow a section well, along each side, edges included.

    Parameters
    ----------
    perimeter, te : arc of the whole loop, and of the trailing edge, mm
    radii         : of the leading and the trailing edge, mm
    points        : that were measured
    """
    steps = float(np.clip(points / 2 / POINTS_A_STEP, *BODY))
    there = _graded(te, radii[0], radii[1], te / steps)
    back = _graded(perimeter - te, radii[1], radii[0], (perimeter - te) / steps)
    return there, te + back


def _graded(length: float, first: float, last: float, body: float) -> Vector:
    """Steps from one edge to the other, growing away from both."""
    x = np.linspace(0.0, length, 2001)
    step = np.minimum(AT_EDGE * first + GROWTH * x, AT_EDGE * last + GROWTH * (length - x))
    rate = 1.0 / np.minimum(step, body)
    mass = np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * np.diff(x))])
    count = max(int(np.ceil(mass[-1])), 2)
    return np.interp(np.linspace(0.0, mass[-1], count + 1), mass, x)


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
