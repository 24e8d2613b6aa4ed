"""A flow at many times at once: stops by doubling, a short series between them."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.linalg import expm

from bladecad.arrays import Array, Points, Vector
from bladecad.fit.flow import Flow

MOST_DOUBLINGS: Final = 15
TERMS: Final = 20  # of the series, over steps with |A| h below 1/2


def run(flow: Flow, t: Vector) -> Points:
    """Return x(t) = C exp(A t) z0 for t in [0, 1], (k, 3), mm; not finite beyond the floats.

    As `evaluate`, with one exponential instead of one for every t.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        states = _stops(flow)
        near = np.rint(t * (len(states) - 1)).astype(int)
        h = (t - near / (len(states) - 1))[:, None]
        term = total = states[near]
        for j in range(1, TERMS):
            term = (term @ flow.A.T) * (h / j)
            total = total + term
        return np.asarray(total @ flow.C.T)


def _stops(flow: Flow) -> Array:
    """States at equal steps from 0 to 1: exp(A 2h) = exp(A h)^2 takes one half to the other."""
    norm = max(float(np.linalg.norm(flow.A, 2)), 1.0)
    doublings = int(np.clip(np.ceil(np.log2(norm)), 0, MOST_DOUBLINGS))
    E = step = expm(flow.A / 2**doublings)
    states = flow.z0[None]
    for _ in range(doublings):
        states = np.concatenate([states, states @ E.T])
        E = E @ E
    return np.concatenate([states, states[-1:] @ step.T])
