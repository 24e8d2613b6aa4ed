"""The paper's own fits: the flow whose field best matches the differences of the points."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from bladecad.arrays import Array, Points, Vector, frozen
from bladecad.errors import DataError, FitError, ToleranceError
from bladecad.fit.differences import Model, Scheme, Solver, differences, regress
from bladecad.fit.flow import Flow
from bladecad.fit.orbit import Orbit
from bladecad.fit.second_order import Ends, missed, second_order_flow
from bladecad.fit.steps import Spacing, parameters, steps_of

ENDS_MET = 1e-10  # mm, and relative to the largest coordinate; rounding alone stays below it


@final
@dataclass(frozen=True, eq=False)
class MatchingFit:
    """A flow found by matching derivatives, and how far it is from its points.

    flow      : the curve, t from 0
    t         : (k,) float, the parameter of each point
    distance  : (k,) float, mm, |x(t_n) - X_n| at the same parameter; infinite where x overflows
    rank      : directions of the state that the points visit
    condition : largest over smallest singular value kept, of the matrix the solver inverts
    residual  : rms of |dz/dt - A z| over the differences, mm per unit of t (squared: second order)
    reason    : why the fit failed, "" if it did not
    """

    flow: Flow
    t: Vector
    distance: Vector
    rank: int
    condition: float
    residual: float
    reason: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "t", frozen(self.t))
        object.__setattr__(self, "distance", frozen(self.distance))


def identify(
    points: Points,
    steps: Vector,
    *,
    model: Model = "paper",
    scheme: Scheme = "forward",
    solver: Solver = "lstsq",
    ends: Ends | None = None,
) -> MatchingFit:
    """Find the linear flow whose field best matches the differences of one line, eqs. (2)-(7).

    Minimises sum_n |dz_n/dt_n - A z_n|^2 over A.

    Parameters
    ----------
    points : (k, 3) float
        mm, leading edge first.
    steps : (k-1,) float
        dt > 0; `uniform_steps` or `arc_length_steps`, eq. (8).
    model : {"paper", "affine", "second-order"}
        The state z: x as in the paper; (x, 1), independent of the origin; or (x, x', 1), which can
        meet end conditions.
    scheme : {"forward", "midpoint"}
        "forward" takes z at the start of each step, eq. (2), error O(dt); "midpoint" half-way,
        error O(dt^2). For "second-order", x' and x'' are forward or central differences.
    solver : {"lstsq", "normal"}
        "normal" is eq. (7), A = D X^T (X X^T)^-1.
    ends : Ends
        For "second-order" only: what the curve must meet, to 1e-10.

    Returns
    -------
    MatchingFit

    Raises
    ------
    FitError
        If there are fewer points than the state has dimensions.
    DataError
        If a step is not positive, or there is not one between each two points.
    ToleranceError
        If end conditions are asked of a first-order model.

    Notes
    -----
    1. Eq. (7) inverts X X^T; lstsq on X has the same minimiser and the square root of its condition
       number. Planar sections leave directions unvisited; both take the minimum-norm A.
    2. "paper" starts at the first point, as the paper does, and so does "affine". The start of
       "second-order" is not given by the data: it is found by least squares on the curve itself.
    3. "affine" and "second-order" are found about the centroid and in units of the line's size, so
       that moving the blade or changing its units moves or scales the curve and no more.
    """
    points, steps = np.asarray(points, dtype=np.float64), np.asarray(steps, dtype=np.float64)
    _check(points, steps, model, ends)
    t = parameters(steps)
    scale, centre = (1.0, np.zeros(3)) if model == "paper" else _frame(points)
    y = (points - centre) / scale
    Z, D = differences(y, steps, model, scheme)
    M, rank, condition = regress(Z, D, solver)
    if model == "second-order":
        flow = second_order_flow(M[:, 3:6], M[:, :3], (scale, centre), points, t, ends or Ends())
    else:
        flow = _first_order_flow(M, (scale, centre), y[0])
    residual = scale * np.sqrt(np.mean(np.sum((D - Z @ M.T) ** 2, axis=1)))
    distance = _distance(flow, t, points)
    reason = _reason(flow, distance, points, t, ends or Ends())
    return MatchingFit(flow, t, distance, rank, condition, float(residual), reason)


def blend(points_i: Points, points_j: Points, u: float) -> Points:
    """Blend two sections point by point, X(u) = u X_i + (1 - u) X_j: u = 1 at i, 0 at j = i + 1."""
    return u * points_i + (1.0 - u) * points_j


def homotopy(
    points_i: Points,
    points_j: Points,
    u: Vector,
    *,
    spacing: Spacing = "arc-length",
    model: Model = "paper",
    scheme: Scheme = "forward",
    solver: Solver = "lstsq",
) -> tuple[MatchingFit, ...]:
    """Blend the data of two neighbouring sections and fit again at every u.

    A(u) = D(u) X(u)^T (X(u) X(u)^T)^-1 with X(u) = u X_i + (1 - u) X_j, started at X_1(u).

    Parameters
    ----------
    points_i, points_j : (k, 3) float
        mm, both leading edge first and with as many points.
    u : (m,) float
        The paper's, 1 at section i and 0 at section i + 1: against the span, which is bladecad's u.
    spacing : {"arc-length", "uniform"}
        Steps of the blended points, eq. (8), or equal ones.
    model, scheme, solver
        As in `identify`.
    """
    lines = [blend(points_i, points_j, float(v)) for v in u]
    return tuple(
        identify(line, steps_of(line, spacing), model=model, scheme=scheme, solver=solver)
        for line in lines
    )


def _first_order_flow(M: Array, output: tuple[float, Vector], start: Vector) -> Flow:
    scale, centre = output
    d = M.shape[1]
    A = np.zeros((d, d))
    A[:3] = M
    C = np.column_stack([scale * np.eye(3), centre])[:, :d]
    return Flow(A, C, np.append(start, 1.0)[:d])


def _distance(flow: Flow, t: Vector, points: Points) -> Vector:
    with np.errstate(over="ignore", invalid="ignore"):
        curve = Orbit(flow.A * t[-1], flow.z0)(t / t[-1]) @ flow.C.T
        distance = np.linalg.norm(curve - points, axis=1)
    return np.where(np.isfinite(distance), distance, np.inf)


def _frame(points: Points) -> tuple[float, Vector]:
    centre = points.mean(axis=0)
    return float(np.sqrt(np.mean(np.sum((points - centre) ** 2, axis=1)))), centre


def _check(points: Points, steps: Vector, model: Model, ends: Ends | None) -> None:
    needed = {"paper": 4, "affine": 5, "second-order": 9}[model]
    if len(points) < needed:
        raise FitError(
            f"a line of {len(points)} points cannot determine the {model} model: {needed} are "
            "needed; take a smaller model or more points"
        )
    if steps.shape != (len(points) - 1,) or not np.all(steps > 0):
        raise DataError(
            f"{len(points)} points need {len(points) - 1} steps above 0, got {steps.shape} with a "
            f"smallest of {steps.min(initial=np.inf):.3g}; use arc_length_steps"
        )
    if ends is not None and model != "second-order":
        raise ToleranceError(f'the {model} model cannot meet end conditions; take "second-order"')


def _reason(flow: Flow, distance: Vector, points: Points, t: Vector, ends: Ends) -> str:
    if not np.isfinite(distance).all():
        return f"the flow leaves the floats at t = {t[np.argmax(np.isinf(distance))]:.3f}"
    gap, allowed = missed(flow, ends, float(t[-1])), ENDS_MET * max(1.0, np.abs(points).max())
    return "" if gap <= allowed else f"end conditions missed by {gap:.1e} mm, {allowed:.1e} allowed"
