"""A cloud that stands in for the nominal while the pose is still searched for."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import final

import numpy as np
from scipy.spatial import cKDTree

from bladecad.arrays import Array, Points, Vector, frozen, seal
from bladecad.surface.blade import BladeSurface, normals
from bladecad.surface.loft import SIDES, graded

COUNT = 20_000
GRID = (161, 321)  # places along u and t from which the cloud is drawn


@final
@dataclass(frozen=True, eq=False)
class StandIn:
    """Points spread evenly over the sides of a blade.

    points, normals : (n, 3) float, mm and unit vectors out of the metal
    spacing         : mm between neighbours
    chord           : mm, mean over the span
    """

    points: Points
    normals: Points
    spacing: float
    chord: float

    def __post_init__(self) -> None:
        n = len(self.points)
        seal(self, points=(n, 3), normals=(n, 3))

    @cached_property
    def tree(self) -> cKDTree:
        """For the nearest of the points."""
        return cKDTree(self.points)

    @cached_property
    def centre(self) -> Vector:
        """Centre of the area, (3,), mm."""
        return frozen(self.points.mean(axis=0))

    def every(self, step: int) -> StandIn:
        """Only every step-th point: quicker where the pose is still far off."""
        spacing = self.spacing * step**0.5
        return StandIn(self.points[::step], self.normals[::step], spacing, self.chord)

    @property
    def reach(self) -> float:
        """Root mean square distance from the centre, mm: what a rotation is worth."""
        return reach(self.points)


def stand_in(surface: BladeSurface) -> StandIn:
    """Draw points from both sides, as many to every square millimetre."""
    u, t = np.linspace(0.0, 1.0, GRID[0]), graded(GRID[1])
    um, tm = 0.5 * (u[1:] + u[:-1]), 0.5 * (t[1:] + t[:-1])
    found = [(surface(s, um, tm), normals(surface, s, um, tm), _areas(surface(s, u, t)))
             for s in SIDES]  # fmt: skip
    X, n, area = (np.concatenate([f[i].reshape(-1, *f[i].shape[2:]) for f in found])
                  for i in range(3))  # fmt: skip
    mass = np.cumsum(area)
    drawn = np.searchsorted(mass, mass[-1] * (np.arange(COUNT) + 0.5) / COUNT)
    drawn = np.unique(drawn)
    ends = surface("suction", um, np.array([0.0, 1.0]))
    chord = float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).mean())
    return StandIn(X[drawn], n[drawn], float(np.sqrt(mass[-1] / len(drawn))), chord)


def reach(points: Points) -> float:
    """Root mean square distance from the centre, mm."""
    return float(np.sqrt(np.sum(np.var(points, axis=0))))


def _areas(X: Array) -> Array:
    """Areas of the cells of a grid, from their diagonals."""
    return np.asarray(
        0.5 * np.linalg.norm(np.cross(X[1:, 1:] - X[:-1, :-1], X[1:, :-1] - X[:-1, 1:]), axis=2)
    )


def thinned(points: Points, cells: int = 40) -> Points:
    """One point of every cell of a lattice, so that dense patches of a scan do not count more.

    The lattice turns with the cloud: its axes are the principal ones.
    """
    centred = points - points.mean(axis=0)
    laid = centred @ np.linalg.svd(centred, full_matrices=False)[2].T
    step = max(float(np.ptp(laid, axis=0).max()) / cells, 1e-300)
    at = np.floor((laid - laid.min(axis=0)) / step).astype(np.int64)
    key = at @ np.array([1, cells + 1, (cells + 1) ** 2])
    first = np.unique(key, return_index=True)[1]
    return np.asarray(points[np.sort(first)])
