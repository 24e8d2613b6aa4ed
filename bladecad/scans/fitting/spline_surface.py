"""A smooth surface of splines through all points, with as many spans as the points ask for."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import Final, NamedTuple

import numpy as np

from bladecad.arrays import Points, Vector
from bladecad.curves.sides import BladeLines
from bladecad.errors import DataError
from bladecad.scans.fitting.descent import descend
from bladecad.scans.fitting.freedom import Freedom, freedom
from bladecad.scans.fitting.knots import breaks_along
from bladecad.scans.fitting.laid_on import laid_on, through
from bladecad.scans.fitting.local import Splines
from bladecad.scans.fitting.neighbours import Scatter
from bladecad.scans.fitting.prior import roughness
from bladecad.surface.blade import BladeSurface

log = logging.getLogger(__name__)
Progress = Callable[[str], None]

LADDER: Final = ((11, 0.36), (15, 0.30), (21, 0.25), (29, 0.21), (41, 0.18))  # stations, rad a span
LESS: Final = 0.85  # of the lack of fit, as a square; a rung that leaves more is not taken
EACH: Final = 6  # points a span at least
FEW: Final = 60_000  # points of the first passes
MANY: Final = 300_000  # points of the others
FIRST_PASSES: Final = 3
STIFF_PASSES: Final = 2
DAMPING: Final = 0.3  # of moves along a section: at an edge, splines would slide over each other
FAR: Final = 0.02
FINEST: Final = 5e-4  # mm, rms; nobody asks for less, and exact points would for ever more spans
FLOOR: Final = 0.005  # mm; scatter below which no point is an outlier, first and last


class Smooth(NamedTuple):
    """A surface of splines, how it came about, and what it leaves.

    surface : BladeSurface
    breaks  : of its splines along the sides
    scatter : of the points about it
    passes  : that it took
    coarser : the one with fewer spans before it; None of the first
    """

    surface: BladeSurface
    breaks: Vector
    scatter: Scatter
    passes: int
    coarser: Smooth | None = None

    @property
    def criterion(self) -> str:
        """Why it has these spans, in a sentence."""
        size = f"{len(self.surface.span) - 1} spans along it, {2 * len(self.breaks) - 2} round it"
        if self.scatter.correlation <= 0.0:
            return (
                f"{size}: neighbouring residuals are unrelated, their correlation is within two "
                "standard errors of zero; what is left is noise"
            )
        if _is_noise(self.scatter):
            return f"{size}: points lie within {1e3 * FINEST:g} um of it, rms"
        return (
            f"{size}: neighbouring residuals stay related (correlation at least "
            f"{self.scatter.correlation:.3f}), and more spans do not change that, would have fewer "
            f"than {EACH} points each, or fold an edge over"
        )


def smooth_surface(
    points: Points, start: BladeLines, axis: Vector, progress: Progress = lambda _: None
) -> Smooth:
    """Lay a surface through the points, finer until what is left of neighbours is unrelated.

    Three hundred thousand of them say as much of its sections as all do.

    Raises
    ------
    DataError
        If there are fewer points than the coarsest surface needs.
    """
    points = points[:: -(-len(points) // MANY)]
    rough = through(start)  # noise that a finer surface follows would ask for ever more breaks
    best = _first(points, rough, axis, progress)
    for stations, turn in LADDER[1:]:
        breaks = breaks_along(rough, turn)
        if _is_noise(best.scatter) or len(points) < _needed(stations, breaks):
            break
        finer = _finer(points, best, stations, breaks, axis, progress)
        if finer.scatter.lack > LESS * best.scatter.lack:
            break
        best = finer
    return best


def _first(points: Points, surface: BladeSurface, axis: Vector, progress: Progress) -> Smooth:
    """The coarsest surface: a few passes over a few points, one over all."""
    stations, turn = LADDER[0]
    breaks = breaks_along(surface, turn)
    if len(points) < _needed(stations, breaks):
        raise DataError(
            f"{len(points)} points are on the airfoil, {_needed(stations, breaks)} are needed to "
            "lay a surface through them; scan closer"
        )
    surface, free = _written(surface, stations, breaks, axis, progress)
    few, prior = points[:: -(-len(points) // FEW)], roughness(surface, free, FAR)
    for _ in range(FIRST_PASSES):
        step = descend(surface, free, few, prior, FAR, DAMPING)
        surface = step.surface
    prior = roughness(surface, free, step.scatter.noise)
    step = descend(surface, free, points, prior, FLOOR, DAMPING)
    return _told(Smooth(step.surface, breaks, step.scatter, 1))


def _finer(
    points: Points, last: Smooth, stations: int, breaks: Vector, axis: Vector, progress: Progress
) -> Smooth:
    """The next rung, from where the last one stands."""
    surface, free = _written(last.surface, stations, breaks, axis, progress)
    prior = roughness(surface, free, last.scatter.noise)
    step = descend(surface, free, points, prior, FLOOR, DAMPING)
    return _told(Smooth(step.surface, breaks, step.scatter, last.passes + 1, last))


def _is_noise(scatter: Scatter) -> bool:
    return scatter.correlation <= 0.0 or scatter.excess * scatter.noise <= FINEST


def stiffened(points: Points, last: Smooth, factor: float, axis: Vector) -> Smooth:
    """The same spans, smoothness weighed more: where noise has folded an edge over."""
    basis = Splines.on(last.breaks)
    free, surface = freedom(last.surface, basis, axis), last.surface
    prior = roughness(surface, free, last.scatter.noise).times(factor)
    for _ in range(STIFF_PASSES):
        step = descend(surface, free, points, prior, FLOOR, DAMPING)
        surface = step.surface
    passes = last.passes + STIFF_PASSES
    return _told(Smooth(surface, last.breaks, step.scatter, passes, last.coarser))


def _written(
    surface: BladeSurface, stations: int, breaks: Vector, axis: Vector, progress: Progress
) -> tuple[BladeSurface, Freedom]:
    progress(f"fit a smooth surface, {stations - 1} x {2 * len(breaks) - 2} spans")
    basis = Splines.on(breaks)
    written = laid_on(surface, (basis, basis), np.linspace(0.0, 1.0, stations))
    return written, freedom(written, basis, axis)


def _told(found: Smooth) -> Smooth:
    log.info("%d x %d: %s", len(found.surface.span), 2 * len(found.breaks), found.scatter)
    return found


def _needed(stations: int, breaks: Vector) -> int:
    return EACH * (stations - 1) * 2 * (len(breaks) - 1)
