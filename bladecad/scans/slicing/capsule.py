"""Points round a thin section put in order: along its camber line, and about the ends of it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final, final

import numpy as np
from scipy.spatial import cKDTree

from bladecad.arrays import Array, Points, Vector, seal

EDGE: Final = 0.35  # of the radius of the end: spacing of knots about an edge
GROWTH: Final = 0.15  # of the distance from the edge
BODY: Final = 1.0 / 45.0  # of the chord: spacing along the sides


@final
@dataclass(frozen=True, eq=False)
class Capsule:
    """Coordinates about a line that lies inside a section: along the outline, and away from it.

    The outline of constant distance is a capsule: one side of the line, half a circle about its
    end, the other side, half a circle about its begin. `along` counts on that capsule, its half
    circles having the radii `ends`; every section that the line lies well inside is a graph on it.

    line : (n, 2) float, mm, dense
    ends : radius about begin and end of the line, mm
    """

    line: Points
    ends: tuple[float, float]

    def __post_init__(self) -> None:
        seal(self, line=(None, 2))

    @cached_property
    def run(self) -> Vector:
        """Arc length of the line at its points, (n,), mm."""
        steps = np.linalg.norm(np.diff(self.line, axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)])

    @cached_property
    def marks(self) -> Vector:
        """Where side, end, other side and begin stop, (4,), mm; the last is the whole length."""
        length, (begin, end) = self.run[-1], self.ends
        return np.cumsum([length, np.pi * end, length, np.pi * begin])

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self.line)

    def place(self, points: Points) -> tuple[Vector, Vector]:
        """How far along the capsule a point lies, and its distance from the line, (k,), mm."""
        _, near = self._tree.query(points)
        best, foot, at = np.full(len(points), np.inf), np.zeros_like(points), np.zeros(len(points))
        for first in (np.maximum(near - 1, 0), np.minimum(near, len(self.line) - 2)):
            a, d = self.line[first], self.line[first + 1] - self.line[first]
            square = np.einsum("kx,kx->k", d, d)
            s = np.clip(np.einsum("kx,kx->k", points - a, d) / square, 0.0, 1.0)
            q = a + s[:, None] * d
            off = np.einsum("kx,kx->k", points - q, points - q)
            nearer = off < best
            best, foot = np.where(nearer, off, best), np.where(nearer[:, None], q, foot)
            at = np.where(nearer, self.run[first] + s * np.sqrt(square), at)
        return self._along(points - foot, at), np.sqrt(best)

    def _along(self, away: Points, at: Vector) -> Vector:
        length, (begin, end), marks = self.run[-1], self.ends, self.marks
        T0, T1 = (_unit(self.line[j] - self.line[i]) for i, j in ((0, 1), (-2, -1)))
        T = np.stack([np.gradient(self.line[:, i], self.run) for i in (0, 1)], axis=1)
        t = np.stack([np.interp(at, self.run, T[:, i]) for i in (0, 1)], axis=1)
        left = t[:, 0] * away[:, 1] - t[:, 1] * away[:, 0] >= 0.0
        along = np.where(left, at, marks[1] + length - at)
        turn1 = np.arctan2(away @ T1, away @ np.array([-T1[1], T1[0]]))  # 0 on the left, pi right
        turn0 = np.arctan2(-(away @ T0), -(away @ np.array([-T0[1], T0[0]])))
        along = np.where((at >= length), length + end * np.mod(turn1, 2.0 * np.pi), along)
        along = np.where((at <= 0.0), marks[2] + begin * np.mod(turn0, 2.0 * np.pi), along)
        return np.asarray(np.clip(along, 0.0, marks[3]))

    def back(self, along: Vector, away: Vector) -> Points:
        """Points at places along the capsule and distances from the line, (k, 2), mm."""
        length, (begin, end), marks = self.run[-1], self.ends, self.marks
        part = np.searchsorted(marks[:3], along, side="right")
        at = np.select([part == 0, part == 1, part == 2], [along, length, marks[2] - along], 0.0)
        T = np.stack([np.gradient(self.line[:, i], self.run) for i in (0, 1)], axis=1)
        T[0], T[-1] = self.line[1] - self.line[0], self.line[-1] - self.line[-2]
        t = np.stack([np.interp(at, self.run, T[:, i]) for i in (0, 1)], axis=1)
        t /= np.linalg.norm(t, axis=1, keepdims=True)
        foot = np.stack([np.interp(at, self.run, self.line[:, i]) for i in (0, 1)], axis=1)
        turn = np.select(
            [part == 0, part == 1, part == 2],
            [np.zeros_like(along), (along - marks[0]) / end, np.full_like(along, np.pi)],
            np.pi + (along - marks[2]) / begin,
        )
        left = np.stack([-t[:, 1], t[:, 0]], axis=1)
        out = np.cos(turn)[:, None] * left + np.sin(turn)[:, None] * t
        return np.asarray(foot + away[:, None] * out)

    @property
    def tips(self) -> tuple[tuple[Vector, float], tuple[Vector, float]]:
        """Where the section ends about, and its radius there: end and begin of the line."""
        T0, T1 = (_unit(self.line[j] - self.line[i]) for i, j in ((0, 1), (-2, -1)))
        begin, end = self.ends
        return (self.line[-1] + end * T1, end), (self.line[0] - begin * T0, begin)

    def warp(self, count: int = 4001) -> tuple[Vector, Vector]:
        """Places along the capsule, and the number of knots up to each of them."""
        (begin, end), marks = self.ends, self.marks
        edges = marks[0] + 0.5 * np.pi * end, marks[2] + 0.5 * np.pi * begin
        return graded(float(marks[3]), edges, (end, begin), count)


def graded(
    length: float, edges: tuple[float, float], radii: tuple[float, float], count: int
) -> tuple[Vector, Vector]:
    """Places on a loop, and the number of knots up to each: close at the edges, far between."""
    x = np.linspace(0.0, length, count)
    density = np.full(count, 2.0 / (BODY * length))
    for place, radius in zip(edges, radii, strict=True):
        d = np.abs(x - place)
        d = np.maximum(np.minimum(d, length - d) - radius, 0.0)
        density = np.maximum(density, 1.0 / (EDGE * radius + GROWTH * d))
    steps = 0.5 * (density[1:] + density[:-1]) * np.diff(x)
    return x, np.concatenate([[0.0], np.cumsum(steps)])


def _unit(v: Array) -> Vector:
    return np.asarray(v / np.linalg.norm(v))
