"""The whole surface fitted to all points of a scan at once."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np
from threadpoolctl import threadpool_limits

from bladecad.arrays import Lines, Points, Vector, seal
from bladecad.curves.repair import repaired
from bladecad.curves.sides import BladeLines, split_sides
from bladecad.deviation.feet import Feet
from bladecad.deviation.nominal import Nominal, nominal_of
from bladecad.deviation.project import project
from bladecad.errors import DataError, FitError
from bladecad.fit.blade import BladeFit, Order
from bladecad.fit.judge import SIDES, Bench, Errors, SideErrors, judge
from bladecad.fit.order import fit_blade
from bladecad.scans.descent import descend, standing
from bladecad.scans.freedom import freedom
from bladecad.scans.knots import breaks_along
from bladecad.scans.laid_on import sections_of
from bladecad.scans.local import Splines
from bladecad.scans.neighbours import scatter
from bladecad.scans.prior import roughness
from bladecad.scans.spline_surface import DAMPING, FLOOR, Smooth, smooth_surface, stiffened
from bladecad.surface.blade import BladeSurface
from bladecad.surface.loft import graded

log = logging.getLogger(__name__)
Progress = Callable[[str], None]
FINEST: Final = 0.002  # mm; flows need not follow the smooth surface closer
SHARE: Final = 0.5  # of the noise, to which the flows follow the smooth surface
PASSES: Final = 2
STRAYED: Final = 8.0  # sigmas from the smooth surface: no flow follows the points there
DENSE: Final = 401  # places of a section at which the flows are judged
STIFFER: Final = (10.0, 100.0, 1000.0)  # times the weight of smoothness


@final
@dataclass(frozen=True, eq=False)
class WholeFit:
    """A blade surface and all points of the airfoil on it.

    fit         : modal; its lines are sections of the smooth surface, its errors those from them
    surface     : S(u,t), fitted to all points
    points      : (k, 3) float, mm
    feet        : (k,) of all of them; the distance is the deviation
    weight      : (k,) float, 1 .. 0; 0 for points that are no part of the surface
    noise       : sigma of the points, mm, from differences of neighbours
    excess      : rms of those that count over the noise; 1 where only noise is left
    correlation : of neighbouring residuals, 0 where only noise is left
    criterion   : why this order and these spans
    passes      : that it took, over many points or all
    """

    fit: BladeFit
    surface: BladeSurface
    points: Points
    feet: Feet
    weight: Vector
    noise: float
    excess: float
    correlation: float
    criterion: str
    passes: int

    def __post_init__(self) -> None:
        seal(self, points=(None, 3), weight=(len(self.points),))


def fit_scan(
    points: Points,
    start: BladeLines,
    axis: Vector,
    *,
    tolerance: float,
    order: Order | None = None,
    progress: Progress = lambda _: None,
) -> WholeFit:
    """Fit S(u,t) to all points of an airfoil.

    First a smooth surface of splines is laid through the points, with as many spans as neighbouring
    residuals ask for; it is free of noise, as sections cut from the points are not. Its sections
    give edges, rates and order of the flows; these are then fitted to all points in turn.

    Parameters
    ----------
    points : (k, 3) float, mm
        Of the airfoil alone.
    start : BladeLines
        Sections through them, good to some 50 um.
    axis : (3,) float, unit
        Stacking axis; the surface moves across it.
    tolerance : float
        mm; the flows follow the smooth surface to half the noise, but no closer than 2 um and no
        coarser than the tolerance.
    order : Order, optional
        Fixed; otherwise the smallest that does.

    Raises
    ------
    DataError
        If the points are too few for a surface.
    FitError
        If the flows cannot follow.
    """
    smooth, lines = _sections(points, smooth_surface(points, start, axis, progress), axis)
    fitted = _flows(smooth, lines, tolerance, order, progress)
    return _settled(points, smooth, fitted, axis, tolerance, progress)


def _sections(points: Points, smooth: Smooth, axis: Vector) -> tuple[Smooth, BladeLines]:
    """Cut the smooth surface into sections; stiffen it where noise has folded their edges."""
    for factor in STIFFER:
        try:
            return smooth, _split(smooth)
        except DataError as error:
            log.info("%s; smoothness is weighed %g times", error, factor)
            smooth = stiffened(points, smooth, factor, axis)
    return smooth, _split(smooth)


def _split(smooth: Smooth) -> BladeLines:
    found = sections_of(smooth.surface, smooth.surface.span, smooth.breaks)
    sections = repaired(found, ordered=True)
    try:
        return split_sides(sections, edges="find")
    except DataError:
        return split_sides(sections)


def _flows(
    smooth: Smooth, lines: BladeLines, tolerance: float, order: Order | None, progress: Progress
) -> BladeFit:
    """Fit flows to sections of the smooth surface."""
    close = float(np.clip(SHARE * smooth.scatter.noise, min(FINEST, tolerance), tolerance))
    progress("fit the flows")
    with threadpool_limits(1):
        try:
            return fit_blade(lines, tolerance=close, order=order, noise=close, progress=progress)
        except FitError as error:
            if not isinstance(error.best, BladeFit):
                raise
            return error.best


def _settled(
    points: Points,
    smooth: Smooth,
    fitted: BladeFit,
    axis: Vector,
    tolerance: float,
    progress: Progress,
) -> WholeFit:
    """Move the flows to all points, and judge what is left."""
    lines = fitted.lines
    surface = BladeSurface(
        lines.span, fitted.suction, fitted.pressure, "spline", lines.le, lines.te
    )
    breaks = breaks_along(surface)
    in_t = Splines.on(np.sort(np.concatenate([breaks, 0.5 * (breaks[1:] + breaks[:-1])])))
    free = freedom(surface, in_t, axis)
    prior = roughness(surface, free, smooth.scatter.noise)
    bound = max(STRAYED * max(smooth.scatter.noise, fitted.tolerance), fitted.errors.largest)
    for k in range(PASSES):
        progress(f"fit the surface, pass {k + 1}")
        step = descend(surface, free, points, prior, FLOOR, DAMPING)
        log.info("moved by %.3g mm rms; %s", step.motion, step.scatter)
        if _errors(step.surface, lines).largest > bound:
            log.info("that leaves the smooth surface by more than %.3g mm, and is not taken", bound)
            break
        surface = step.surface
    feet, weight = standing(surface, points, FLOOR)
    used = free.in_u.size * free.ways / max(int((weight > 0.0).sum()), 1)
    left = scatter(feet, weight > 0, used)
    errors = judge(Bench.of(lines), surface.suction, surface.pressure)
    fit = replace(
        fitted, suction=surface.suction, pressure=surface.pressure, errors=errors,
        tolerance=tolerance, reason="",
    )  # fmt: skip
    return WholeFit(
        fit, surface, points, feet, weight, left.noise, left.excess, left.correlation,
        smooth.criterion, smooth.passes + PASSES,
    )  # fmt: skip


def _errors(surface: BladeSurface, lines: BladeLines) -> Errors:
    """Distances of the sections of the smooth surface from S along its normal.

    The move along a section that points do not feel would show at equal parameters.
    """
    nominal, t = nominal_of(surface), graded(DENSE)
    sides = [_of_side(nominal, lines.sample(side, t), t) for side in SIDES]
    at_equal = judge(Bench.of(lines), surface.suction, surface.pressure)
    return replace(at_equal, suction=sides[0], pressure=sides[1])


def _of_side(nominal: Nominal, points: Lines, t: Vector) -> SideErrors:
    d = np.abs(project(nominal, points.reshape(-1, 3)).distance).reshape(len(points), -1)
    rms = np.sqrt(np.mean(d**2, axis=1))
    return SideErrors(d.max(axis=1), rms, t[d.argmax(axis=1)], d.max(axis=1))
