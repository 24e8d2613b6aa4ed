"""The flow of a linear differential equation, in closed form and by Runge-Kutta."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from scipy.linalg import expm

from bladecad.arrays import Array, Points, Vector, seal


@final
@dataclass(frozen=True, eq=False)
class Flow:
    """A curve x(t) = C exp(A t) z0: the output of z' = A z, started at z0.

    A  : (d, d) float, the field; the paper's A is this with d = 3
    C  : (3, d) float, mm, the output
    z0 : (d,) float, the state at t = 0
    """

    A: Array
    C: Array
    z0: Vector

    def __post_init__(self) -> None:
        d = np.size(self.z0)
        seal(self, A=(d, d), C=(3, d), z0=(d,))


def propagator(A: Array, t: Vector) -> Array:
    """Return exp(A t) at every t, (k, d, d); infinite or NaN where it leaves the floats."""
    with np.errstate(over="ignore", invalid="ignore"):
        return np.asarray(expm(np.multiply.outer(np.asarray(t, dtype=np.float64), A)))


def response(A: Array, C: Array, t: Vector, order: int = 0) -> Array:
    """Return C A^r exp(A t), (k, 3, d): what takes a start z0 to the r-th derivative of its curve.

    The curve is linear in its start. Whatever is asked of it at any t, of any order, is a row of
    this matrix, and so end conditions and least squares over z0 are linear problems.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        return np.asarray(C @ np.linalg.matrix_power(A, order) @ propagator(A, t))


def evaluate(flow: Flow, t: Vector, order: int = 0) -> Points:
    """Evaluate the curve, or its derivative of any order, d^r x/dt^r = C A^r exp(A t) z0.

    Parameters
    ----------
    flow : Flow
    t : (k,) float
        Anywhere, in any order, with any spacing.
    order : int
        r, 0 for the points.

    Returns
    -------
    (k, 3) float
        mm; infinite or NaN where exp(A t) leaves the floats.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        return np.asarray(response(flow.A, flow.C, t, order) @ flow.z0)


def trajectory_rk4(flow: Flow, t: Vector, substeps: int = 1) -> Points:
    """Follow the flow from t = 0 through every t in turn by the classical Runge-Kutta method.

    Parameters
    ----------
    flow : Flow
    t : (k,) float
        Visited in the order given.
    substeps : int
        Equal steps between neighbouring t; the error falls with their fourth power.

    Returns
    -------
    (k, 3) float
        mm, to be compared with `evaluate`.
    """
    z, states = flow.z0, []
    for gap in np.diff(t, prepend=0.0):
        for _ in range(substeps):
            z = _rk4_step(flow.A, z, gap / substeps)
        states.append(z)
    return np.asarray(states) @ flow.C.T


def _rk4_step(A: Array, z: Vector, h: float) -> Vector:
    with np.errstate(over="ignore", invalid="ignore"):
        k1 = A @ z
        k2 = A @ (z + h / 2 * k1)
        k3 = A @ (z + h / 2 * k2)
        k4 = A @ (z + h * k3)
        return z + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
