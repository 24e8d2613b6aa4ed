"""How well points cover one side of a surface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from bladecad.arrays import Array, Points, Vector, seal
from bladecad.deviation.nearest.feet import Feet
from bladecad.surface.blade import BladeSurface, SideName

NEIGHBOURS: Final = 8  # the circle round a point that reaches so many is 1.6 spacings wide
ALONE: Final = 3.0  # times the circles of its neighbours: a point that tells nothing of the cover


@final
@dataclass(frozen=True, eq=False)
class Cover:
    """One side of a surface, at places a step apart, and the points near them.

    u, t  : (a,) and (b,) float, of the places
    X     : (a, b, 3) float, mm
    area  : (a, b) float, mm^2, that each place stands for
    near  : (a, b) float, mm, to the nearest point
    reach : (a, b) float, mm, to the eighth neighbour of the loneliest point at the place, 0 where
            there is none
    """

    side: SideName
    u: Vector
    t: Vector
    X: Array
    area: Array
    near: Array
    reach: Array

    def __post_init__(self) -> None:
        shape = (len(self.u), len(self.t))
        seal(self, u=(None,), t=(None,), X=(*shape, 3), area=shape, reach=shape)


def cover_of(
    surface: BladeSurface, side: SideName, feet: Feet, own: NDArray[np.intp], step: float
) -> Cover:
    """Places a step apart, hub, tip and edges among them."""
    x = np.linspace(0.0, 1.0, 17)
    tall, long = (
        float(np.linalg.norm(surface(side, x, x, *order), axis=2).max())
        for order in ((1, 0), (0, 1))
    )
    u, t = (np.linspace(0.0, 1.0, max(int(size / step), 8) + 1) for size in (tall, long))
    X = surface(side, u, t)
    near, reach = np.full(X.shape[:2], np.inf), np.zeros(X.shape[:2])
    if len(own) > NEIGHBOURS:
        tree = tree_of(feet.foot[own])
        near = nearest(tree, X.reshape(-1, 3), 1)[0].reshape(near.shape)
        away, beside = nearest(tree, feet.foot[own], NEIGHBOURS + 1)
        far = away[:, -1]
        told = far <= ALONE * np.median(far[beside[:, 1:]], axis=1)
        at = (
            np.rint(x[own[told]] * (len(y) - 1)).astype(int) for x, y in ((feet.u, u), (feet.t, t))
        )
        np.maximum.at(reach, tuple(at), far[told])
    return Cover(side, u, t, X, _areas(X), near, reach)


def tree_of(points: Points) -> KDTree:
    """A tree of points, quick to plant."""
    return KDTree(points, balanced_tree=False, compact_nodes=False)


def nearest(
    tree: KDTree, X: Points, count: int, within: float = np.inf
) -> tuple[Array, NDArray[np.intp]]:
    """Distances and numbers of the nearest few, infinite beyond `within`."""
    away, which = tree.query(X, count, distance_upper_bound=within, workers=-1)
    return np.asarray(away), np.asarray(which, dtype=np.intp)


def _areas(X: Array) -> Array:
    """Area that each place of a grid stands for, mm^2."""
    n = np.cross(np.gradient(X, axis=0), np.gradient(X, axis=1))
    area = np.linalg.norm(n, axis=2)
    area[[0, -1]] *= 0.5
    area[:, [0, -1]] *= 0.5
    return np.asarray(area)


def area_of(surface: BladeSurface, side: SideName) -> float:
    """Area of one side, mm^2."""
    x = np.linspace(0.0, 1.0, 41)
    return float(_areas(surface(side, x, x)).sum())
