"""Foot points: the nearest place on the blade surface, and the signed distance to it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from bladecad.arrays import Array, Points, Vector, seal
from bladecad.surface.blade import BladeSurface, SideName, outward
from bladecad.surface.triangulate import SIDES

STEPS = 30
STILL = 1e-9  # change of u and t at which a foot has settled


@final
@dataclass(frozen=True, eq=False)
class Feet:
    """Where points stand on a blade surface.

    distance : (k,) float, mm, positive outside the metal
    suction  : (k,) bool, whether the foot is on the suction side
    u, t     : (k,) float, parameters of the foot
    """

    distance: Vector
    suction: NDArray[np.bool_]
    u: Vector
    t: Vector

    def __post_init__(self) -> None:
        k = len(self.distance)
        seal(self, distance=(k,), u=(k,), t=(k,))


def project(surface: BladeSurface, points: Points, u: Vector, t: Vector) -> Feet:
    """Find the nearest place of the two sides for every point.

    Parameters
    ----------
    surface : BladeSurface
    points : (k, 3) float, mm
    u, t : (m,) and (n,) float
        A grid, fine against the curvature; the search starts at its nearest vertex on each side.

    Notes
    -----
    Gauss-Newton with step halving on |S(u,t) - x|^2, clamped to the patch, from the nearest grid
    vertex on each side; the nearer foot is kept. At a round edge both sides share the edge line, so
    a foot beyond it is found from the other side.
    """
    found = [_on_side(surface, s, points, u, t) for s in SIDES]
    (ds, us, ts), (dp, up, tp) = found
    on_suction = np.abs(ds) <= np.abs(dp)
    return Feet(
        np.where(on_suction, ds, dp),
        on_suction,
        np.where(on_suction, us, up),
        np.where(on_suction, ts, tp),
    )


def _on_side(
    surface: BladeSurface, name: SideName, points: Points, u: Vector, t: Vector
) -> tuple[Vector, Vector, Vector]:
    grid = surface(name, u, t)
    seed = np.asarray(cKDTree(grid.reshape(-1, 3)).query(points)[1])
    uv = _descend(surface, name, points, np.column_stack([u[seed // len(t)], t[seed % len(t)]]))
    away = np.linalg.norm(points - surface.at(name, uv[:, 0], uv[:, 1]), axis=1)
    return _sign(surface, name, points, uv) * away, uv[:, 0], uv[:, 1]


def _descend(surface: BladeSurface, name: SideName, points: Points, uv: Array) -> Array:
    """Gauss-Newton steps, each halved until the point is nearer, inside the unit square."""
    uv = uv.copy()
    moving = np.arange(len(points))
    for _ in range(STEPS):
        trial = _nearer(surface, name, points[moving], uv[moving])
        still = np.abs(trial - uv[moving]).max(axis=1) < STILL
        uv[moving] = trial
        moving = moving[~still]
        if not len(moving):
            break
    return uv


def _nearer(surface: BladeSurface, name: SideName, points: Points, uv: Array) -> Array:
    """One step for every point, or none where no shorter step brings the surface nearer."""
    u, t = uv.T
    r = surface.at(name, u, t) - points
    J = np.stack([surface.at(name, u, t, 1, 0), surface.at(name, u, t, 0, 1)], axis=2)
    step, before = _step(J, r, uv), np.einsum("kx,kx->k", r, r)
    for _ in range(8):
        trial = np.clip(uv + step, 0.0, 1.0)
        r = surface.at(name, trial[:, 0], trial[:, 1]) - points
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


def _sign(surface: BladeSurface, name: SideName, points: Points, uv: Array) -> Vector:
    n = np.cross(
        surface.at(name, uv[:, 0], uv[:, 1], 1, 0), surface.at(name, uv[:, 0], uv[:, 1], 0, 1)
    )
    side = np.einsum("kx,kx->k", points - surface.at(name, uv[:, 0], uv[:, 1]), n) * outward(
        surface, name
    )
    return np.where(side >= 0, 1.0, -1.0)
