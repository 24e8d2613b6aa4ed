"""The densified lines of one side, sampled at parameters that all its sections share."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import final

import numpy as np

from bladecad.arrays import Array, Vector, seal
from bladecad.curves.sides import BladeLines, Side

FINE = 4000  # cells in which the density of the points is counted
NARROWEST = 2e-5  # of the side: gaps between points are not resolved below this
ROUNDING = 1e-9  # of a step, so that a whole number of them stays one
DIGITS = 9  # of t: a moved blade is sampled at the very same parameters


@final
@dataclass(frozen=True, eq=False)
class Samples:
    """One side of a blade, dense.

    t      : (N,) float, rising from 0 to 1, closer where any section has closer points
    points : (m, N, 3) float, mm
    """

    t: Vector
    points: Array

    def __post_init__(self) -> None:
        seal(self, t=(None,), points=(None, len(self.t), 3))

    @cached_property
    def centre(self) -> Vector:
        """Mean of all points, (3,), mm."""
        return np.asarray(self.points.mean(axis=(0, 1)))

    def about(self, centre: Vector) -> Array:
        """(N, 3m) float: the sections side by side, as offsets from a point."""
        return np.asarray((self.points - centre).transpose(1, 0, 2).reshape(len(self.t), -1))


def by_section(columns: Array) -> Array:
    """Turn (k, 3m) columns back into (m, k, 3)."""
    return np.asarray(columns.reshape(len(columns), -1, 3).transpose(1, 0, 2))


def densify(lines: BladeLines, side: Side, per_gap: int) -> Samples:
    """Sample a side `per_gap` times in every gap between the measured points of any section."""
    t = shared_parameters(lines.parameters(side), per_gap)
    return Samples(t, lines.sample(side, t))


def shared_parameters(measured: list[Vector], per_gap: int) -> Vector:
    """Parameters from 0 to 1 whose density is nowhere below `per_gap` times that of any section."""
    edges = np.linspace(0.0, 1.0, FINE + 1)
    middle = 0.5 * (edges[1:] + edges[:-1])
    density = np.zeros(FINE)
    for t in measured:
        ends = np.unique(np.concatenate([[0.0], t, [1.0]]))
        gaps = np.maximum(np.diff(ends), NARROWEST)
        density = np.maximum(density, per_gap / gaps[np.searchsorted(ends, middle) - 1])
    count = np.concatenate([[0.0], np.cumsum(density / FINE)])
    steps = int(np.ceil(count[-1] - ROUNDING))
    t = np.interp(np.linspace(0.0, count[-1], steps + 1), count, edges)
    return np.round(t, DIGITS)
