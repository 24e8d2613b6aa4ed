"""The paper's rungs: flows found line by line by matching derivatives."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import PchipInterpolator

from bladecad.arrays import Array, Points, Vector
from bladecad.fit.differences import Model, Scheme
from bladecad.fit.matching import MatchingFit, identify
from bladecad.fit.second_order import Ends
from bladecad.fit.steps import Spacing, parameters, steps_of
from bladecad.replay.curves import Curves
from bladecad.replay.running import run
from bladecad.replay.subject import JUDGED, Stretch


def matched_fits(
    stretch: Stretch, spacing: Spacing, model: Model, scheme: Scheme
) -> list[MatchingFit]:
    """Fit every line by itself, eqs. (2)-(8); "second-order" meets the first and last point."""
    return [_fit(points, steps_of(points, spacing), model, scheme) for points in stretch.points]


def matched(stretch: Stretch, spacing: Spacing, model: Model, scheme: Scheme) -> Curves:
    """Fit every line and run its flow at the points and between them."""
    fits = matched_fits(stretch, spacing, model, scheme)
    times = model_times(stretch, spacing)
    dense = np.array([run(fit.flow, t) for fit, t in zip(fits, times, strict=True)])
    return Curves(dense[:, ::JUDGED], dense)


def model_times(stretch: Stretch, spacing: Spacing) -> Array:
    """Times at which the flows are judged, (m, K): those of the points, monotone between them."""
    times = [parameters(steps_of(points, spacing)) for points in stretch.points]
    return np.array([PchipInterpolator(stretch.t, t)(stretch.judged.t) for t in times])


def _fit(points: Points, steps: Vector, model: Model, scheme: Scheme) -> MatchingFit:
    ends = Ends(start=points[0], end=points[-1]) if model == "second-order" else None
    return identify(points, steps, model=model, scheme=scheme, ends=ends)
