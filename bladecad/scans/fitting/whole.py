"""The whole surface fitted to all points of a scan at once."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from bladecad.arrays import Points, Vector, seal
from bladecad.curves.sides import BladeLines
from bladecad.deviation.nearest.feet import Feet
from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.fit.blade import BladeFit, Order
from bladecad.scans.fitting.descent import descend, standing
from bladecad.scans.fitting.flows import errors_of, flows_of, sections_for
from bladecad.scans.fitting.freedom import freedom
from bladecad.scans.fitting.knots import breaks_along
from bladecad.scans.fitting.local import Splines
from bladecad.scans.fitting.neighbours import scatter
from bladecad.scans.fitting.prior import roughness
from bladecad.scans.fitting.spline_surface import DAMPING, FLOOR, Smooth, smooth_surface
from bladecad.surface.blade import BladeSurface

log = logging.getLogger(__name__)
Progress = Callable[[str], None]
PASSES: Final = 5  # over all points, at most
STILL: Final = 0.03  # of the noise: a smaller rms move is none
LEAST: Final = 1e-4  # mm; nor is one below this
STRAYED: Final = 8.0  # sigmas from the smooth surface: no flow follows the points there


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
    smooth, lines = sections_for(points, smooth_surface(points, start, axis, progress), axis)
    fitted = flows_of(smooth, lines, tolerance, order, progress)
    return _settled(points, smooth, fitted, axis, tolerance, progress)


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
    after, passes, motion = surface, 0, np.inf
    still = max(STILL * smooth.scatter.noise, LEAST)
    while motion > still and passes < PASSES:
        passes += 1
        progress(f"fit the surface, pass {passes}")
        after, _, _, motion, left = descend(after, free, points, prior, FLOOR, DAMPING)
        log.info("moved by %.3g mm rms; %s", motion, left)
    nominal = nominal_of(after)
    errors = errors_of(nominal, lines)
    if errors.largest > bound:
        log.info("that leaves the smooth surface by %.3g mm, and is not taken", errors.largest)
        after, nominal = surface, nominal_of(surface)
        errors = errors_of(nominal, lines)
    feet, weight = standing(nominal, points, FLOOR)
    used = free.in_u.size * free.ways / max(int((weight > 0.0).sum()), 1)
    left = scatter(feet, weight > 0, used)
    fit = replace(
        fitted, suction=after.suction, pressure=after.pressure, errors=errors,
        tolerance=tolerance, reason="",
    )  # fmt: skip
    return WholeFit(
        fit, after, points, feet, weight, left.noise, left.excess, left.correlation,
        smooth.criterion, smooth.passes + passes,
    )  # fmt: skip
