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
    scale = np.empty(len(t))
    for own in np.array_split(np.argsort(t), BINS):
        scale[own] = max(_scale(residual[own]), floor)
    x = residual / (REJECT * scale)
    return np.asarray(np.maximum(1.0 - x * x, 0.0) ** 2)


def _scale(residual: Vector) -> float:
    return MAD * float(np.median(np.abs(residual))) if len(residual) else 0.0
