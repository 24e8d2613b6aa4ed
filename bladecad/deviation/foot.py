"""Foot points: the nearest place on the blade surface, and the signed distance to it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

import numpy as np
from scipy.spatial import cKDTree

from bladecad.arrays import Array, Mask, Points, Vector, seal
from bladecad.surface.blade import BladeSurface, SideName, outward

Chart = Callable[[Vector, Vector, int, int], Array]  # X(u,v) or a partial derivative, (k, 3)

STEPS = 100  # Gauss-Newton halves the error a step as far from an edge as its radius
STILL = 1e-9  # change of u and t at which a foot has settled
ACROSS = np.linspace(0.0, 1.0, 9)  # seeds across the face of a cut-off edge


@final
@dataclass(frozen=True, eq=False)
class Feet:
    """Where points stand on a blade surface.

    distance : (k,) float, mm, positive outside the metal
    suction  : (k,) bool, whether the foot is on the suction side, or that half of an edge face
    u, t     : (k,) float, parameters of the foot; t is 0 or 1 on an edge face
    """

    distance: Vector
    suction: Mask
    u: Vector
    t: Vector

    def __post_init__(self) -> None:
        k = len(self.distance)
        seal(self, distance=(k,), u=(k,), t=(k,))


def project(surface: BladeSurface, points: Points, u: Vector, t: Vector) -> Feet:
    """Find the nearest place of the sides, and of the faces of cut-off edges, for every point.

    Parameters
    ----------
    surface : BladeSurface
    points : (k, 3) float, mm
    u, t : (m,) and (n,) float
        A grid, fine against the curvature; the search starts at its nearest vertex on each face.

    Notes
    -----
    Gauss-Newton with step halving on |X(u,v) - x|^2, clamped to the face, from the nearest grid
    vertex on each; the nearest foot is kept. At a round edge both sides share the edge line, so a
    foot beyond it is found from the other side.
    """
    found = [_on_side(surface, name, points, u, t) for name in ("suction", "pressure")]
    if surface.le == "blunt":
        found.append(_on_edge(surface, 0.0, points, u))
    if surface.te == "blunt":
        found.append(_on_edge(surface, 1.0, points, u))
    nearest = np.argmin([np.abs(feet.distance) for feet in found], axis=0)

    def chosen(values: list[Array] | list[Mask]) -> Array:
        return np.asarray(np.choose(nearest, values))

    return Feet(
        chosen([f.distance for f in found]),
        chosen([f.suction for f in found]).astype(bool),
        chosen([f.u for f in found]),
        chosen([f.t for f in found]),
    )


def _on_side(surface: BladeSurface, name: SideName, points: Points, u: Vector, t: Vector) -> Feet:
    def chart(u: Vector, t: Vector, du: int = 0, dt: int = 0) -> Array:
        return surface.at(name, u, t, du, dt)

    distance, uv = _foot(chart, points, surface(name, u, t), u, t)
    sign = outward(surface, name)
    suction = np.full(len(points), name == "suction")
    return Feet(sign * distance, suction, uv[:, 0], uv[:, 1])


def _on_edge(surface: BladeSurface, end: float, points: Points, u: Vector) -> Feet:
    """Feet on the ruled face of a cut-off edge, X(u,v) = (1 - v) S(u,end) + v P(u,end)."""

    def chart(u: Vector, v: Vector, du: int = 0, dv: int = 0) -> Array:
        t = np.full(len(u), end)
        S, P = (surface.at(name, u, t, du, 0) for name in ("suction", "pressure"))
        return P - S if dv else S + v[:, None] * (P - S)

    rows = [chart(u, np.full(len(u), v), 0, 0) for v in ACROSS]
    distance, uv = _foot(chart, points, np.stack(rows, axis=1), u, ACROSS)
    sign = outward(surface, "suction") * (1.0 if end else -1.0)
    return Feet(sign * distance, uv[:, 1] < 0.5, uv[:, 0], np.full(len(points), end))


def _foot(chart: Chart, points: Points, grid: Array, u: Vector, v: Vector) -> tuple[Vector, Array]:
    """Distance, positive on the side of X_u x X_v, and parameters of the feet on one face."""
    seed = np.asarray(cKDTree(grid.reshape(-1, 3)).query(points)[1])
    uv = _descend(chart, points, np.column_stack([u[seed // len(v)], v[seed % len(v)]]))
    away = points - chart(uv[:, 0], uv[:, 1], 0, 0)
    n = np.cross(chart(uv[:, 0], uv[:, 1], 1, 0), chart(uv[:, 0], uv[:, 1], 0, 1))
    sign = np.where(np.einsum("kx,kx->k", away, n) >= 0, 1.0, -1.0)
    return sign * np.linalg.norm(away, axis=1), uv


def _descend(chart: Chart, points: Points, uv: Array) -> Array:
    """Gauss-Newton steps, each halved until the point is nearer, inside the unit square."""
    uv = uv.copy()
    moving = np.arange(len(points))
    for _ in range(STEPS):
        trial = _nearer(chart, points[moving], uv[moving])
        still = np.abs(trial - uv[moving]).max(axis=1) < STILL
        uv[moving] = trial
        moving = moving[~still]
        if not len(moving):
            break
    return uv


def _nearer(chart: Chart, points: Points, uv: Array) -> Array:
    """One step for every point, or none where no shorter step brings the face nearer."""
    u, v = uv.T
    r = chart(u, v, 0, 0) - points
    J = np.stack([chart(u, v, 1, 0), chart(u, v, 0, 1)], axis=2)
    step, before = _step(J, r, uv), np.einsum("kx,kx->k", r, r)
    for _ in range(8):
        trial = np.clip(uv + step, 0.0, 1.0)
        r = chart(trial[:, 0], trial[:, 1], 0, 0) - points
        worse = np.einsum("kx,kx->k", r, r) > before
        if not worse.any():
            return trial
        step = np.where(worse[:, None], 0.5 * step, step)
    return np.where(worse[:, None], uv, trial)


def _step(J: Array, r: Array, uv: Array) -> Array:
    """Gauss-Newton step; a parameter held at its bound by the gradient does not move."""
    g = np.einsum("kxi,kx->ki", J, r)
    held = ((uv <= 0.0) & (g > 0.0)) | ((uv >= 1.0) & (g < 0.0))
    J = np.where(held[:, None, :], 0.0, J)
    H = np.einsum("kxi,kxj->kij", J, J)
    H = H + np.where(held[:, :, None] & np.eye(2, dtype=bool), 1.0, 0.0)
    return np.asarray(np.linalg.solve(H, np.where(held, 0.0, -g)[:, :, None])[:, :, 0])
