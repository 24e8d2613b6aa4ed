"""Twisted, tapered, cambered blades in closed form, as patches, and their exact volume."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import make_interp_spline

from bladecad.surface.patch import SplinePatch

Array = NDArray[np.float64]
Ends = Literal["planar", "cylinders"]


def blade(
    *,
    sections: int = 7,
    nodes: int = 40,
    ends: Ends = "planar",
    blunt_leading: bool = False,
    blunt_trailing: bool = False,
) -> tuple[SplinePatch, SplinePatch]:
    """Return suction and pressure patch of a blade 40 mm long with (nodes + 2) poles in t."""
    span = np.linspace(0.0, 1.0, sections)
    first, last = 0.06 * blunt_leading, 1.0 - 0.1 * blunt_trailing
    suction, pressure = (
        _patch(span, first, last, nodes, sign=sign, ends=ends) for sign in (1.0, -1.0)
    )
    poles = np.array(pressure.poles)
    if not blunt_leading:
        poles[:, 0] = suction.poles[:, 0]
    if not blunt_trailing:
        poles[:, -1] = suction.poles[:, -1]
    return suction, with_poles(pressure, poles)


def with_poles(patch: SplinePatch, poles: Array) -> SplinePatch:
    return SplinePatch(poles, patch.knots_u, patch.knots_t, patch.degree_u, patch.degree_t)


def moved(patch: SplinePatch, rotation: Array, shift: Array) -> SplinePatch:
    return with_poles(patch, patch.poles @ rotation.T + shift)


def _patch(
    span: Array, first: float, last: float, nodes: int, *, sign: float, ends: Ends
) -> SplinePatch:
    t = np.linspace(0.0, 1.0, nodes)
    theta = np.pi * (first + (last - first) * t)
    along = _on_stage(_section(span, theta, sign), ends, span)
    slopes = [_slope(span, theta[k], sign, ends) * np.pi * (last - first) for k in (0, -1)]
    side = make_interp_spline(t, along, k=3, axis=1, bc_type=([(1, slopes[0])], [(1, slopes[1])]))
    lines = np.moveaxis(side.c, 0, 1) if side.c.shape[0] != len(span) else side.c
    stack = make_interp_spline(span, lines, k=min(3, len(span) - 1), axis=0)
    return SplinePatch(stack.c, stack.t, side.t, stack.k, 3)


def _section(span: Array, theta: Array, sign: float) -> Array:
    """Camber line 1 - x^2 with a thickness round at both ends; (m, n, 3) with r in the last."""
    s, angle = span[:, None], theta[None, :]
    chord, thick, turn = 30.0 - 8.0 * s, 0.07 - 0.03 * s, 0.3 + 0.7 * s
    x = -np.cos(angle)
    y = 0.15 * (1 - x**2) + sign * thick * np.sin(angle) * (1.1 - 0.3 * x)
    x, y = chord / 2 * x, chord / 2 * y
    turned = np.cos(turn) * x - np.sin(turn) * y, np.sin(turn) * x + np.cos(turn) * y
    return np.stack([*turned, np.broadcast_to(100.0 + 40.0 * s, x.shape)], axis=-1)


def _slope(span: Array, theta: float, sign: float, ends: Ends, h: float = 1e-3) -> Array:
    """Central difference of order six in theta, (m, 3)."""
    steps = h * np.array([-3.0, -2.0, -1.0, 1.0, 2.0, 3.0])
    points = _on_stage(_section(span, theta + steps, sign), ends, span)
    return np.einsum("mkx,k->mx", points, np.array([-1, 9, -45, 45, -9, 1]) / (60 * h))


def _on_stage(sections: Array, ends: Ends, span: Array) -> Array:
    if ends == "planar":
        return sections
    x, y, r = np.moveaxis(sections, -1, 0)
    return np.stack([x, r * np.sin(y / r), r * np.cos(y / r)], axis=-1)


def volume(suction: SplinePatch, pressure: SplinePatch) -> float:
    """Volume by the divergence theorem, exact for polynomials: Gauss-Legendre on every knot span.

    The open sides are closed by ruled patches; a plane with the same outline has the same flux.
    """
    rim = sum(
        sign * _flux(_ruled(suction, pressure, axis, end))
        for axis, end, sign in ((0, 0, 1.0), (0, -1, -1.0), (1, 0, 1.0), (1, -1, -1.0))
    )
    return abs(_flux(pressure) - _flux(suction) + rim)


def _ruled(suction: SplinePatch, pressure: SplinePatch, axis: int, end: int) -> SplinePatch:
    rows = [np.take(side.poles, end, axis=axis) for side in (suction, pressure)]
    line = np.array([0.0, 0.0, 1.0, 1.0])
    if axis == 0:
        return SplinePatch(np.stack(rows, 0), line, suction.knots_t, 1, suction.degree_t)
    return SplinePatch(np.stack(rows, 1), suction.knots_u, line, suction.degree_u, 1)


def _flux(patch: SplinePatch) -> float:
    """Integral of X . (X_u x X_t) / 3 over the patch."""
    u, wu = _gauss(patch.knots_u)
    t, wt = _gauss(patch.knots_t)
    cross = np.cross(patch(u, t, 1, 0), patch(u, t, 0, 1))
    return float(np.einsum("ijx,ijx,i,j->", patch(u, t), cross, wu, wt)) / 3


def _gauss(knots: Array, order: int = 6) -> tuple[Array, Array]:
    x, w = np.polynomial.legendre.leggauss(order)
    breaks = np.unique(knots)
    half = np.diff(breaks)[:, None] / 2
    middle = (breaks[1:] + breaks[:-1])[:, None] / 2
    return (middle + half * x).ravel(), (half * w).ravel()
