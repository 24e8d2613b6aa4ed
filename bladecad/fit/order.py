"""Tolerance in, order out: the smallest modal fit that meets a tolerance on every section."""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import replace

from bladecad.curves.sides import BladeLines
from bladecad.errors import FitError
from bladecad.fit.blade import BladeFit, Order, SpectrumKind
from bladecad.fit.modal import Data, fit_order, prepare
from bladecad.fit.segments import fit_segments
from bladecad.one_thread import one_thread

log = logging.getLogger(__name__)

LADDER = (
    (1, 5), (1, 7), (2, 7), (2, 9), (2, 11), (3, 11), (3, 13), (3, 15),
    (4, 15), (4, 17), (5, 17), (5, 19), (6, 21), (7, 23), (8, 25),
)  # fmt: skip
FAR, VERY_FAR = 3.0, 12.0  # times the tolerance: take two, or three, rungs at once
STALLED = 5  # rungs without a better fit after which the data, not the order, set the limit
BETTER = 0.9
SIGMAS = 3.0  # a tolerance below this many times the noise is below what the points can say

Progress = Callable[[str], None]


def fit_blade(
    lines: BladeLines,
    *,
    tolerance: float,
    order: Order | None = None,
    spectrum: SpectrumKind = "shared",
    noise: float = 0.0,
    progress: Progress = lambda _: None,
) -> BladeFit:
    """Fit both sides of a blade by flows from edge to edge.

    Parameters
    ----------
    lines : BladeLines
    tolerance : float
        mm; largest distance from the densified lines, anywhere on any section.
    order : Order, optional
        Fixed; otherwise the smallest that meets the tolerance is searched.
    spectrum : {"shared", "varying"}
        One spectrum for all sections of a side, or rates that vary linearly with span.
    noise : float
        mm, scatter of the points. Where no order meets the tolerance the core is restarted at
        knots, but not to follow points that scatter by a third of the tolerance or more.
    progress : callable
        Told what is being tried.

    Returns
    -------
    BladeFit
        With a fixed order it may fall short of the tolerance; `reason` says so.

    Raises
    ------
    FitError
        If no order meets the tolerance; its `best` is the closest fit.
    """
    with one_thread():
        data = prepare(lines)
        if order is not None:
            return fit_order(data, order, tolerance, spectrum=spectrum)
        return _searched(data, tolerance, spectrum, noise, progress)


def _searched(
    data: Data, tolerance: float, spectrum: SpectrumKind, noise: float, progress: Progress
) -> BladeFit:
    """The smallest order that meets the tolerance, segments where none does."""
    best = climb(data, tolerance, spectrum, progress)
    if best.reason and SIGMAS * noise < tolerance:
        best = min(best, fit_segments(data, tolerance, progress), key=_shortfall)
    met(best, noise)
    return best if best.model == "segmented" else trim(data, best, spectrum, progress)


def met(fit: BladeFit, noise: float = 0.0) -> BladeFit:
    """Return a fit that meets its tolerance, refuse another with its numbers."""
    if fit.reason:
        raise FitError(_too_tight(fit, noise), best=fit)
    return fit


def climb(data: Data, tolerance: float, spectrum: SpectrumKind, progress: Progress) -> BladeFit:
    """Go up the ladder of orders until the tolerance is met, or nothing gets better."""
    rung, best, stalled = 0, None, 0
    while rung < len(LADDER) and stalled < STALLED:
        m, p = LADDER[rung]
        progress(f"order {m}, {m}, {p}")
        fit = fit_order(data, Order(m, m, p), tolerance, spectrum=spectrum)
        log.info("%s: largest %.4g mm, rms %.4g mm", fit.order, fit.errors.largest, fit.errors.rms)
        stalled = 0 if best is None or _shortfall(fit) < BETTER * _shortfall(best) else stalled + 1
        best = fit if best is None else min(best, fit, key=_shortfall)
        if not fit.reason:
            return fit
        away = fit.errors.largest / tolerance
        rung += 3 if away > VERY_FAR else 2 if away > FAR else 1
    assert best is not None
    return best


def trim(data: Data, fit: BladeFit, spectrum: SpectrumKind, progress: Progress) -> BladeFit:
    """Take away pairs and degrees one at a time while the tolerance is still met."""
    assert fit.order is not None
    smaller = True
    while smaller:
        smaller = False
        for order in _smaller(fit.order):
            progress(f"order {order.le}, {order.te}, {order.degree}")
            trial = fit_order(data, order, fit.tolerance, spectrum=spectrum, near=fit)
            if not trial.reason:
                fit, smaller = trial, True
                break
    return fit


def _smaller(order: Order) -> list[Order]:
    return [
        *([replace(order, te=order.te - 1)] if order.te > 1 else []),
        *([replace(order, le=order.le - 1)] if order.le > 1 else []),
        *([replace(order, degree=order.degree - 2)] if order.degree > 3 else []),
    ]


def _shortfall(fit: BladeFit) -> float:
    """Largest error; a fit refused for another reason counts as ten times worse."""
    errors = fit.errors
    return errors.largest * (10.0 if fit.reason and errors.largest <= fit.tolerance else 1.0)


def _too_tight(best: BladeFit, noise: float) -> str:
    side, i, t = best.errors.worst()
    floor = (
        f"the points scatter by {1e3 * noise:.2g} um, and to follow them closer would be to follow "
        "the noise; "
        if SIGMAS * noise >= best.tolerance
        else ""
    )
    return (
        f"no order meets {1e3 * best.tolerance:.3g} um: {best.order} comes closest, with "
        f'{1e3 * best.errors.largest:.3g} um on the {side} side of section "{best.lines.names[i]}" '
        f"at t = {t:.3f}; {floor}ask for a --tolerance of {1.1 * best.errors.largest:.2g} mm, look "
        "at the points there, or fix the --order to build it anyway"
    )
