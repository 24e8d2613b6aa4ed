"""Segments: the core restarted at knots, where one polynomial does not follow the body."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from bladecad.arrays import Vector
from bladecad.fit.blade import BladeFit, Order
from bladecad.fit.modal import Data, fit_order, fit_spectra
from bladecad.fit.samples import Samples
from bladecad.fit.sidefit import SideFit
from bladecad.fit.spectrum import Spectrum

START = Order(4, 4, 9)  # the rates of the modes are taken from this modal fit
DEGREE = 5  # of a segment
AT_ONCE = 3  # knots put in each round
MOST = 60
NARROWEST = 12  # dense samples between two knots: more than a gap between points


def fit_segments(data: Data, tolerance: float, progress: Callable[[str], None]) -> BladeFit:
    """Put knots where the error is largest until the tolerance is met.

    Each side gets its own knots; x, x' and x'' stay continuous across them. The best fit is
    returned where no number of knots meets the tolerance.
    """
    modal = fit_order(data, START, tolerance)
    sides = [_restarted(fit, np.empty(0)) for fit in (modal.suction, modal.pressure)]
    best: BladeFit | None = None
    while True:
        count = max(len(s.knots) for s in sides)
        progress(f"{count} knots")
        order = Order(START.le, START.te, DEGREE, count)
        fit = fit_spectra(data, order, (sides[0],), (sides[1],), tolerance)
        if best is None or fit.errors.largest < best.errors.largest:
            best = fit
        more = [
            _knots(s, f, d, tolerance)
            for s, f, d in zip(sides, (fit.suction, fit.pressure), data.bench.dense, strict=True)
        ]
        grown = any(len(k) > len(s.knots) for k, s in zip(more, sides, strict=True))
        if not fit.reason or not grown or max(len(k) for k in more) > MOST:
            return fit if not fit.reason else best
        sides = [
            _restarted(f, k) for f, k in zip((modal.suction, modal.pressure), more, strict=True)
        ]


def _restarted(fit: SideFit, knots: Vector) -> Spectrum:
    basis = fit.bases[0]
    assert isinstance(basis, Spectrum)
    return Spectrum(DEGREE, basis.le, basis.te, knots)


def _knots(spectrum: Spectrum, fit: SideFit, dense: Samples, tolerance: float) -> Vector:
    """The knots of a side, and more where its error, over all sections, is above the tolerance."""
    error = np.linalg.norm(fit(dense.t) - dense.points, axis=2).max(axis=0)
    knots = spectrum.knots
    if error.max() <= tolerance:
        return knots
    for i in np.argsort(-error)[: len(error) // 2]:
        near = np.abs(np.searchsorted(dense.t, np.concatenate([[0.0], knots, [1.0]])) - i)
        if near.min() > NARROWEST:
            knots = np.sort(np.append(knots, float(dense.t[i])))
        if len(knots) >= len(spectrum.knots) + AT_ONCE:
            break
    return knots
