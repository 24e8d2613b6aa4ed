"""Flows fitted to a smooth surface: its sections give edges, rates and order."""

from __future__ import annotations

import logging
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Final

import numpy as np

from bladecad.arrays import Lines, Points, Vector
from bladecad.curves.repair import repaired
from bladecad.curves.sides import BladeLines, split_sides
from bladecad.deviation.nearest.nominal import Nominal
from bladecad.deviation.nearest.project import project
from bladecad.errors import DataError, FitError
from bladecad.fit.blade import BladeFit, Order
from bladecad.fit.judge import SIDES, Bench, Errors, SideErrors, judge
from bladecad.fit.order import fit_blade
from bladecad.one_thread import one_thread
from bladecad.scans.fitting.laid_on import sections_of
from bladecad.scans.fitting.spline_surface import Smooth, stiffened
from bladecad.scans.moved import moved_lines, moved_sections
from bladecad.scans.upright import upright
from bladecad.surface.loft import graded

log = logging.getLogger(__name__)
Progress = Callable[[str], None]

FINEST: Final = 0.002  # mm; flows need not follow the smooth surface closer
SHARE: Final = 0.5  # of the noise, to which the flows follow the smooth surface
CLOSEST: Final = 0.1  # of the noise: closer, flows would follow that of the smooth surface
EXACT: Final = 1e-5  # mm; nor closer than this
STIFFER: Final = (10.0, 100.0, 1000.0)  # times the weight of smoothness
DENSE: Final = 401  # places of a section at which the flows are judged


def sections_for(points: Points, smooth: Smooth, axis: Vector) -> tuple[Smooth, BladeLines]:
    """Cut the smooth surface into sections, a smoother one where noise has folded their edges.

    Raises
    ------
    DataError
        If even then an edge is folded.
    """
    folded: DataError | None = None
    for attempt in _attempts(points, smooth, axis):
        try:
            return attempt, _split(attempt, axis)
        except DataError as error:
            log.info("%s", error)
            folded = error
    raise DataError(
        "the points do not hold the edges of the blade: a smooth surface through them folds over "
        f"there, though smoothness is weighed {STIFFER[-1]:g} times; scan the edges closer, or "
        "give a finer mesh"
    ) from folded


def _attempts(points: Points, smooth: Smooth, axis: Vector) -> Iterator[Smooth]:
    """The surface, stiffer, with fewer spans, and with the fewest stiffer and stiffer."""
    rung = smooth
    yield rung
    yield stiffened(points, rung, STIFFER[0], axis)
    while rung.coarser:
        rung = rung.coarser
        yield rung
    for factor in STIFFER:
        yield stiffened(points, rung, factor, axis)


def _split(smooth: Smooth, axis: Vector) -> BladeLines:
    found = sections_of(smooth.surface, smooth.surface.span, smooth.breaks)
    move = upright(axis, np.vstack([section.points for section in found.sections]))
    stood = repaired(moved_sections(found, move, "z"), ordered=True)
    try:
        lines = split_sides(stood, edges="find")
    except DataError:
        lines = split_sides(stood)
    return moved_lines(lines, np.asarray(np.linalg.inv(move), dtype=np.float64))


def flows_of(
    smooth: Smooth, lines: BladeLines, tolerance: float, order: Order | None, progress: Progress
) -> BladeFit:
    """Fit flows to sections of the smooth surface."""
    noise = smooth.scatter.noise
    close = max(min(max(SHARE * noise, FINEST), tolerance), CLOSEST * noise, EXACT)
    progress("fit the flows")
    with one_thread():
        try:
            return fit_blade(lines, tolerance=close, order=order, noise=close, progress=progress)
        except FitError as error:
            if not isinstance(error.best, BladeFit):
                raise
            return error.best


def errors_of(nominal: Nominal, lines: BladeLines) -> Errors:
    """Distances of sections from a surface along its normal.

    A move along a section, which points do not feel, would show at equal parameters.
    """
    surface, t = nominal.surface, graded(DENSE)
    sides = [_of_side(nominal, lines.sample(side, t), t) for side in SIDES]
    at_equal = judge(Bench.of(lines), surface.suction, surface.pressure)
    return replace(at_equal, suction=sides[0], pressure=sides[1])


def _of_side(nominal: Nominal, points: Lines, t: Vector) -> SideErrors:
    d = np.abs(project(nominal, points.reshape(-1, 3)).distance).reshape(len(points), -1)
    rms = np.sqrt(np.mean(d**2, axis=1))
    return SideErrors(d.max(axis=1), rms, t[d.argmax(axis=1)], d.max(axis=1))
