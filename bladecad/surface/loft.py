"""The surface lofted: its section curves become B-splines in t; along u it stays what it is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from scipy.linalg import solve_triangular

from bladecad.arrays import Array, Mask, Vector
from bladecad.errors import GeometryError
from bladecad.splines import basis, clamped
from bladecad.surface.blade import BladeSurface, SideName
from bladecad.surface.patch import SplinePatch

DEGREE = 3
START, MOST = 16, 600  # spans
SAFE = 0.8  # of the tolerance: what is measured at places must hold between them
ENDS = 3  # poles at each end solved exactly from value, tangent and curvature
SIDES: tuple[SideName, SideName] = ("suction", "pressure")


@final
@dataclass(frozen=True, eq=False)
class Loft:
    """Both sides as B-spline patches on the same knots.

    error : largest distance of the patches from S, at equal (u,t), on a dense grid, mm
    """

    suction: SplinePatch
    pressure: SplinePatch
    error: float


def loft(surface: BladeSurface, *, tolerance: float) -> Loft:
    """Loft the sections of a surface into two tensor-product B-spline patches.

    Parameters
    ----------
    surface : BladeSurface
    tolerance : float
        mm; spans are halved where the measured error is above it.

    Raises
    ------
    GeometryError
        If 600 spans are not enough.

    Notes
    -----
    Along u the poles are those of the law, exact. Along t the curves of all sections are projected
    at once: least squares on graded samples, the first and last three poles from X, X' and X'' at
    the ends, so that the patches meet as S does.
    """
    breaks = first_breaks(surface)
    while len(breaks) <= MOST:
        suction, pressure = _lofted(surface, breaks)
        error = _errors(surface, (suction, pressure), breaks)
        if error.max() <= SAFE * tolerance:
            return Loft(suction, pressure, float(error.max()))
        breaks = halved(breaks, error > SAFE * tolerance)
    raise GeometryError(
        f"the loft is still {1e3 * error.max():.3g} um from the surface with {MOST} spans, "
        f"{1e3 * tolerance:.3g} um are allowed; fit with a larger --tolerance"
    )


def graded(count: int) -> Vector:
    """Parameters from 0 to 1, ever closer towards both edges."""
    x = np.linspace(-1.0, 1.0, count)
    return np.asarray(0.5 * (1.0 + np.tanh(4.5 * x) / np.tanh(4.5)))


def first_breaks(surface: BladeSurface) -> Vector:
    """A few breaks, closer at the edges, and those where the flows themselves are restarted."""
    own = [getattr(b, "knots", np.empty(0)) for s in SIDES for b in surface.side(s).bases]
    breaks = np.unique(np.concatenate([graded(START + 1), *own]))
    return np.asarray(breaks[np.diff(breaks, prepend=-1.0) > 1e-9])


def halved(breaks: Vector, poor: Mask) -> Vector:
    """Halve the poor spans, and any longer one beside them: errors leak out of long neighbours."""
    width = np.diff(breaks)
    beside = np.zeros_like(poor)
    beside[1:] |= poor[:-1] & (width[1:] > 1.5 * width[:-1])
    beside[:-1] |= poor[1:] & (width[:-1] > 1.5 * width[1:])
    halves = 0.5 * (breaks[1:] + breaks[:-1])
    return np.sort(np.concatenate([breaks, halves[poor | beside]]))


def _lofted(surface: BladeSurface, breaks: Vector) -> tuple[SplinePatch, SplinePatch]:
    knots = clamped(breaks, DEGREE)
    samples, weights = gauss(breaks, 5)
    on_suction, on_pressure = (
        curve_poles(surface.side(s)(samples), _ends(surface, s), knots, samples, weights)
        for s in SIDES
    )
    for column, kind in ((0, surface.le), (-1, surface.te)):
        if kind != "blunt":
            on_pressure[:, column] = on_suction[:, column]
    ku, du = surface.knots
    patches = [
        SplinePatch(np.einsum("ki,ilx->klx", surface.cardinal, poles), ku, knots, du, DEGREE)
        for poles in (on_suction, on_pressure)
    ]
    return patches[0], patches[1]


def _ends(surface: BladeSurface, name: SideName) -> Array:
    """X, X', X'' of every section at t = 0, then at t = 1, (2, 3, m, 3)."""
    side = surface.side(name)
    return np.array([[side(np.array([end]), r)[:, 0] for r in range(ENDS)] for end in (0.0, 1.0)])


def curve_poles(
    curves: Array, ends: Array, knots: Vector, samples: Vector, weights: Vector
) -> Array:
    """Poles of the section curves, (m, n, 3)."""
    M = basis(knots, DEGREE, samples)
    n = M.shape[1]
    first = _end_rows(knots, 0.0)[:, :ENDS]
    last = _end_rows(knots, 1.0)[:, -ENDS:]
    m = len(curves)
    known = np.zeros((n, m * 3))
    known[:ENDS] = np.linalg.solve(first, ends[0].reshape(ENDS, -1))
    known[-ENDS:] = np.linalg.solve(last, ends[1].reshape(ENDS, -1))
    rest = curves.transpose(1, 0, 2).reshape(len(samples), -1) - M @ known
    w = np.sqrt(weights)[:, None]
    Q, R = np.linalg.qr(w * M[:, ENDS:-ENDS])
    known[ENDS:-ENDS] = solve_triangular(R, Q.T @ (w * rest))
    return known.reshape(n, m, 3).transpose(1, 0, 2)


def _end_rows(knots: Vector, end: float) -> Array:
    return np.concatenate([basis(knots, DEGREE, np.array([end]), r) for r in range(ENDS)])


def gauss(breaks: Vector, count: int) -> tuple[Vector, Vector]:
    """Gauss-Legendre places and weights in every span."""
    nodes, weights = np.polynomial.legendre.leggauss(count)
    half = 0.5 * np.diff(breaks)
    places = breaks[:-1, None] + half[:, None] * (1.0 + nodes)
    return places.ravel(), (half[:, None] * weights).ravel()


def _errors(surface: BladeSurface, patches: Sequence[SplinePatch], breaks: Vector) -> Vector:
    """Largest distance in every span of t, at equal (u,t), mm."""
    between = np.linspace(0.0, 1.0, 10)[1:-1]
    t = (breaks[:-1, None] + np.diff(breaks)[:, None] * between).ravel()
    u = np.append((surface.span[:-1, None] + np.diff(surface.span)[:, None] * between).ravel(), 1.0)
    away = [
        np.linalg.norm(patch(u, t) - surface(s, u, t), axis=2).max(axis=0)
        for patch, s in zip(patches, SIDES, strict=True)
    ]
    return np.asarray(np.max(away, axis=0).reshape(-1, len(between)).max(axis=1))
