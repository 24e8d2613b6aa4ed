"""A section whose points judge one another, and where on the outline each of them lies."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import final

import numpy as np
from scipy.spatial import cKDTree

from bladecad.arrays import Array, Vector
from bladecad.curves.develop import Flat, develop, frame
from bladecad.curves.repair import signed_area
from bladecad.curves.residuals import TINY, Mask, Residuals, Stretches, residuals, runs
from bladecad.data.loops import size
from bladecad.data.sections import Section

NORMAL_WEIGHT = 0.1  # of a size: how far apart the two sides lie for finding the same place
REACH = 3  # points beside one that its cubic or theirs can reach

Group = tuple[int, ...]


@final
@dataclass(frozen=True, eq=False)
class Judged:
    """A section whose points judge one another, some perhaps set aside.

    stretches : of the loop, from corner to corner
    keep      : the points that judge
    """

    section: Section
    flat: Flat
    stretches: Stretches
    keep: Mask

    @classmethod
    def of(cls, section: Section, axis: int) -> Judged:
        """Take all points of a section."""
        flat = develop(section.points, axis)
        return cls(section, flat, runs(section, flat), np.ones(len(section.points), dtype=bool))

    def without(self, group: Group) -> Judged:
        """Set some points aside."""
        keep = self.keep.copy()
        keep[list(group)] = False
        return replace(self, keep=keep)

    def offset(self, i: int) -> float:
        """Offset of a point to the left of the loop, whether it is kept or not."""
        keep = self.keep.copy()
        keep[i] = True
        return float(replace(self, keep=keep).residuals.offset[i])

    @cached_property
    def shadow(self) -> Vector:
        """Largest offset of the points left out within reach of each point, (n,), mm."""
        shadow = np.zeros(len(self.keep))
        for i in np.flatnonzero(~self.keep):
            near = np.arange(i - REACH, i + REACH + 1) % len(shadow)
            shadow[near] = np.maximum(shadow[near], abs(self.offset(int(i))))
        return shadow

    @cached_property
    def size(self) -> float:
        """Diagonal of the box round the section, mm."""
        return size(self.section.points)

    @cached_property
    def residuals(self) -> Residuals:
        """What the kept points say of one another."""
        return residuals(self.section, self.flat, self.stretches, self.keep)

    @cached_property
    def places(self) -> Array:
        """Where each point lies on the outline, (n, 4), so that places of two sections compare."""
        centred = self.flat.points - self.flat.points.mean(axis=0)
        long = frame(centred)[1][0]
        long = long if long[0] >= 0 else -long
        placed = centred @ np.array([[long[0], -long[1]], [long[1], long[0]]]) / self.size
        T = np.roll(placed, -1, axis=0) - np.roll(placed, 1, axis=0)
        T *= np.sign(signed_area(placed)) / np.maximum(np.linalg.norm(T, axis=1), TINY)[:, None]
        return np.hstack([placed, NORMAL_WEIGHT * T])

    @cached_property
    def tree(self) -> cKDTree:
        """Search tree of the places."""
        return cKDTree(self.places)
