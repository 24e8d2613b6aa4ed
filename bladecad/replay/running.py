"""A flow at many times at once."""

from __future__ import annotations

import numpy as np

from bladecad.arrays import Points, Vector
from bladecad.fit.flow import Flow
from bladecad.fit.orbit import Orbit


def run(flow: Flow, t: Vector) -> Points:
    """Return x(t) = C exp(A t) z0 for t in [0, 1], (k, 3), mm; not finite beyond the floats.

    As `evaluate`, with one exponential instead of one for every t.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        return np.asarray(Orbit(flow.A, flow.z0)(t) @ flow.C.T)
