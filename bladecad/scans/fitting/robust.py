"""What a residual is worth: Tukey's weights on a scale that knows where the fit is still poor."""

from __future__ import annotations

from typing import Final

import numpy as np

from bladecad.arrays import Mask, Vector

MAD: Final = 1.4826  # median of |x| to sigma, of a normal distribution
REJECT: Final = 6.0  # sigmas at which a point has no weight any more; 98 % efficient
BINS: Final = 48  # along each side, of equal numbers of points


def weights(residual: Vector, suction: Mask, t: Vector, floor: float) -> Vector:
    """Weigh residuals against the scatter of those at the same place along the section.

    A surface that is still off at an edge is off for all points there: none of them is an outlier.

    Parameters
    ----------
    residual : (k,) float, mm
    suction : (k,) bool
    t : (k,) float
    floor : float
        mm; the scale is nowhere taken to be smaller.

    Returns
    -------
    (k,) float
        (1 - (r / 6 s)^2)^2, or 0; Tukey's biweight.
    """
    worth = np.zeros(len(residual))
    for side in (suction, ~suction):
        which = np.flatnonzero(side)
        if len(which):
            worth[which] = _on_side(residual[which], t[which], floor)
    return worth


def _on_side(residual: Vector, t: Vector, floor: float) -> Vector:
    borders = np.quantile(t, np.linspace(0.0, 1.0, BINS + 1)[1:-1])
    number = np.searchsorted(borders, t)
    bins = np.split(residual[np.argsort(number)], np.cumsum(np.bincount(number, minlength=BINS)))
    scale = np.array([_scale(own) for own in bins[:BINS]])
    x = residual / (REJECT * np.maximum(scale, floor)[number])
    return np.asarray(np.maximum(1.0 - x * x, 0.0) ** 2)


def _scale(residual: Vector) -> float:
    return MAD * float(np.median(np.abs(residual))) if len(residual) else 0.0
