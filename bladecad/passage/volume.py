"""The volume of the passage by quadrature alone, a witness that never met the mesh."""

from __future__ import annotations

import numpy as np

from bladecad.arrays import Array, Vector
from bladecad.passage.channel import SIDES, Channel
from bladecad.passage.cylinder import to_cylinder
from bladecad.passage.trim import Trimmed
from bladecad.passage.walls import Wall
from bladecad.surface.blade import SideName
from bladecad.surface.loft import graded

ALONG, ACROSS, ON_WALL = 4, 5, 5  # Gauss points: a span of t, a piece of u, a piece of wall


def passage_volume(blade: Trimmed, channel: Channel, count: int, angle: float) -> float:
    """Volume of the fluid round one blade of `count`, mm^3: its share of the annulus less metal."""
    return annulus_volume(channel) / count - metal_volume(blade, angle)


def annulus_volume(channel: Channel) -> float:
    """Volume swept by the channel, mm^3.

    Pappus and Green: V = 2 pi times the integral of r dz dr = pi |integral of r^2 dz| round it.
    """
    hub = _along(channel.hub, channel.hub_s[0], channel.hub_s[-1])
    shroud = _along(channel.shroud, channel.shroud_s[0], channel.shroud_s[-1])
    inlet, outlet = (
        _straight(channel.hub(channel.hub_s[[k]])[0], channel.shroud(channel.shroud_s[[k]])[0])
        for k in (0, -1)
    )
    return float(np.pi * abs(hub + outlet - shroud - inlet))


def metal_volume(blade: Trimmed, angle: float) -> float:
    """Volume of the blade between its ends, mm^3.

    The divergence theorem with F = r theta e_theta, div F = 1: it runs along every surface of
    revolution, so the ends on the walls add nothing, V = |integral of r theta dz dr| over both
    sides and blunt edges.
    """
    t, wt = _gauss(graded(81), ALONG)
    of = {side: _flux(blade, side, t, wt, angle) for side in SIDES}
    total = of["suction"] - of["pressure"]
    surface = blade.surface
    for place, kind, sign in ((0.0, surface.le, -1.0), (1.0, surface.te, 1.0)):
        if kind == "blunt":
            total += sign * _strip(blade, place, angle)
    return abs(total)


def _flux(blade: Trimmed, name: SideName, t: Vector, wt: Vector, angle: float) -> float:
    """Integral of r theta (z_u r_t - z_t r_u) over a side, u from end to end at every t."""
    low, high = blade.ends(name, t)
    curves, slopes = (blade.surface.side(name)(t, order) for order in (0, 1))
    breaks = np.union1d(blade.surface.span[1:-1], [0.0, 1.0])
    total = 0.0
    for a, b in zip([-np.inf, *breaks[1:-1]], [*breaks[1:-1], np.inf], strict=True):
        start, stop = np.clip(low, a, b), np.clip(high, a, b)
        for x, w in zip(*np.polynomial.legendre.leggauss(ACROSS), strict=True):
            u = start + 0.5 * (stop - start) * (1.0 + x)
            L, dL = (blade.surface.blend(u, order) for order in (0, 1))
            X, U, T = (
                np.asarray(np.einsum("ki,ikx->kx", a, b))
                for a, b in ((L, curves), (dL, curves), (L, slopes))
            )
            total += w * float(np.sum(wt * 0.5 * (stop - start) * _form(X, U, T, blade, angle)))
    return total


def _strip(blade: Trimmed, t: float, angle: float) -> float:
    """The same over the face of a blunt edge, ruled from suction to pressure side."""
    v, wv = _gauss(np.linspace(0.0, 1.0, 41), ALONG)
    at, total = np.full_like(v, t), 0.0
    S, P = (blade.at(side, v, at) for side in SIDES)
    S_v, P_v = (_by_v(blade, side, v, at) for side in SIDES)
    for x, w in zip(*_gauss(np.array([0.0, 1.0]), ALONG), strict=True):
        X, V = (1.0 - x) * S + x * P, (1.0 - x) * S_v + x * P_v
        total += w * float(np.sum(wv * _form(X, V, P - S, blade, angle)))
    return total


def _by_v(blade: Trimmed, name: SideName, v: Vector, t: Vector) -> Array:
    low, high = (end[0] for end in blade.ends(name, t[:1]))
    return np.asarray(blade.surface.at(name, low + v * (high - low), t, 1, 0) * (high - low))


def _form(X: Array, A: Array, B: Array, blade: Trimmed, angle: float) -> Vector:
    """r theta dz ^ dr of the tangents A and B at X, (k,)."""
    zrt = to_cylinder(X, blade.axis, angle)
    i, j = (blade.axis + 1) % 3, (blade.axis + 2) % 3
    z_a, z_b = A[:, blade.axis], B[:, blade.axis]
    r_a, r_b = ((X[:, i] * D[:, i] + X[:, j] * D[:, j]) / zrt[:, 1] for D in (A, B))
    return np.asarray(zrt[:, 1] * (zrt[:, 2] - angle) * (z_a * r_b - z_b * r_a))


def _along(wall: Wall, start: float, stop: float) -> float:
    """Integral of r^2 dz along a wall."""
    inside = wall.nodes[(wall.nodes > start) & (wall.nodes < stop)]
    s, w = _gauss(np.concatenate([[start], inside, [stop]]), ON_WALL)
    return float(np.sum(w * wall(s)[:, 1] ** 2 * wall(s, 1)[:, 0]))


def _straight(a: Vector, b: Vector) -> float:
    """Integral of r^2 dz from a to b."""
    mean = (a[1] ** 2 + a[1] * b[1] + b[1] ** 2) / 3.0
    return float(mean * (b[0] - a[0]))


def _gauss(breaks: Vector, count: int) -> tuple[Vector, Vector]:
    nodes, weights = np.polynomial.legendre.leggauss(count)
    half = 0.5 * np.diff(breaks)[:, None]
    return (breaks[:-1, None] + half * (1.0 + nodes)).ravel(), (half * weights).ravel()
