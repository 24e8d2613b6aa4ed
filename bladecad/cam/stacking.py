"""The stacking axis of a blade: the line through the centroids of its sections."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from bladecad.arrays import Points, Vector, seal
from bladecad.surface.blade import BladeSurface
from bladecad.surface.loft import SIDES, graded

T = graded(801)


@final
@dataclass(frozen=True, eq=False)
class StackingAxis:
    """A line from hub to tip.

    point     : (3,) float, mm, the mean of the centroids
    direction : (3,) float, unit, towards the tip
    """

    point: Vector
    direction: Vector

    def __post_init__(self) -> None:
        seal(self, point=(3,), direction=(3,))


def stacking_axis(surface: BladeSurface) -> StackingAxis:
    """Lay a line through the centroids of all sections, by least squares.

    A leaned or bowed blade has no line that meets them all; this one is the nearest.
    """
    found = centroids(surface, surface.span)
    point = found.mean(axis=0)
    direction = np.linalg.svd(found - point, full_matrices=False)[2][0]
    return StackingAxis(point, direction * np.sign(direction @ (found[-1] - found[0])))


def centroids(surface: BladeSurface, u: Vector) -> Points:
    """Centroids of the area of sections u = const, (len(u), 3), mm.

    Of the strip ruled between the sides, so that sections on stream surfaces have one too.
    """
    S, P = (surface(s, u, T) for s in SIDES)
    across = S - P
    step = 0.5 * (np.diff(S, axis=1) + np.diff(P, axis=1))
    area = np.linalg.norm(np.cross(0.5 * (across[:, 1:] + across[:, :-1]), step), axis=2)
    middle = 0.25 * (S[:, 1:] + S[:, :-1] + P[:, 1:] + P[:, :-1])
    return np.asarray(np.einsum("ut,utx->ux", area, middle) / area.sum(axis=1)[:, None])
