"""A surface moved towards all points at once: foot points, weights, one sparse solve; again."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from bladecad.arrays import Array, Mask, Points, Vector
from bladecad.deviation.nearest.feet import Feet
from bladecad.deviation.nearest.nominal import Nominal, nominal_of
from bladecad.deviation.nearest.project import project
from bladecad.one_thread import one_thread
from bladecad.scans.fitting.freedom import Freedom, local_poles, moved
from bladecad.scans.fitting.neighbours import Scatter, of_the_airfoil, scatter
from bladecad.scans.fitting.normal import Normal, accumulate
from bladecad.scans.fitting.prior import Roughness
from bladecad.scans.fitting.robust import weights
from bladecad.scans.fitting.solve import best_move
from bladecad.surface.blade import BladeSurface, normals
from bladecad.surface.loft import SIDES, graded

PROBES: Final = (41, 101)  # places in u and t at which a move is measured
TOLD_BY: Final = 300_000  # points that tell what is left


class Step(NamedTuple):
    """One pass.

    surface : after it
    feet    : of the points on the surface before it
    weight  : (k,) float; what each of them counted
    motion  : rms move of the surface along its normal, mm
    scatter : what is left after it, to first order, told by some of the points
    """

    surface: BladeSurface
    feet: Feet
    weight: Vector
    motion: float
    scatter: Scatter


def descend(
    surface: BladeSurface,
    free: Freedom,
    points: Points,
    prior: Roughness,
    floor: float,
    damping: float,
) -> Step:
    """Take one Gauss-Newton step of tangent-distance least squares on the points.

    The move d makes up for the distance along the normal, n . d = distance; along the section it is
    damped, tau . d = 0 with a small weight (Blake and Isard; Wang, Pottmann and Liu, Fitting
    B-spline curves to point clouds by curvature-based squared distance minimization, 2006).

    Parameters
    ----------
    surface : BladeSurface
    free : Freedom
    points : (k, 3) float, mm
    prior : Roughness
    floor : float
        mm; scatter below which no point is an outlier.
    damping : float
        Weight of a move along the section, beside one across it.
    """
    feet, weight = standing(nominal_of(surface), points, floor)
    n = feet.normal @ free.axes.T
    tau = (
        np.column_stack([-n[:, 1], n[:, 0]]) / np.maximum(np.linalg.norm(n, axis=1), 1e-9)[:, None]
    )
    M = weight[:, None] * (_products(n) + damping**2 * _products(tau))
    f = n * (weight * feet.distance)[:, None]
    with ThreadPoolExecutor(2) as both:
        counted = (feet.suction & (weight > 0), ~feet.suction & (weight > 0))
        suction, pressure = both.map(lambda which: _sums(free, feet, M, f, which), counted)
    with one_thread():
        y = best_move(free, (suction, pressure), prior, local_poles(surface, free))
    after = moved(surface, free, y)
    some = np.arange(0, len(points), max(len(points) // TOLD_BY, 1))
    left = _left(free, y, feet[some])
    used = free.in_u.size * free.ways / max(int((weight > 0.0).sum()), 1)
    return Step(after, feet, weight, _motion(surface, after), scatter(left, weight[some] > 0, used))


def standing(nominal: Nominal, points: Points, floor: float) -> tuple[Feet, Vector]:
    """Where the points stand on a surface, and what each of them counts."""
    feet = project(nominal, points)
    on = of_the_airfoil(feet)
    weight = np.zeros(len(points))
    weight[on] = weights(feet.distance[on], feet.suction[on], feet.t[on], floor)
    return feet, weight


def _products(a: Array) -> Array:
    return np.column_stack([a[:, 0] ** 2, a[:, 0] * a[:, 1], a[:, 1] ** 2])


def _sums(free: Freedom, feet: Feet, M: Array, f: Array, which: Mask) -> Normal:
    k = np.flatnonzero(which)
    return accumulate(free.in_u, free.in_t, feet.u[k], feet.t[k], M[k], f[k])


def _left(free: Freedom, y: Array, feet: Feet) -> Feet:
    """The same feet, their distances less the move of the surface along its normal."""
    n, distance = feet.normal @ free.axes.T, np.array(feet.distance)
    for local, side in zip(free.local, (feet.suction, ~feet.suction), strict=True):
        poles = np.einsum("kaf,lf->kla", y, local)
        k = np.flatnonzero(side)
        distance[k] -= np.einsum("ka,ka->k", _at(free, poles, feet.u[k], feet.t[k]), n[k])
    return replace(feet, distance=distance)


def _at(free: Freedom, poles: Array, u: Vector, t: Vector) -> Array:
    """The move at places (u_k, t_k), (k, 2), mm."""
    from bladecad.scans.fitting.kernels import blend

    found = np.zeros((len(u), 2))
    blend(*free.in_u.four(u), *free.in_t.four(t), np.ascontiguousarray(poles), found)
    return found


def _motion(before: BladeSurface, after: BladeSurface) -> float:
    u, t = np.linspace(0.0, 1.0, PROBES[0]), graded(PROBES[1])
    d = [
        np.einsum("utx,utx->ut", after(s, u, t) - before(s, u, t), normals(before, s, u, t))
        for s in SIDES
    ]
    return float(np.sqrt(np.mean(np.square(d))))
