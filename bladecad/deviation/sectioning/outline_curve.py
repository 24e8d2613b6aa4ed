"""The outline of a section as a curve in its plane, and feet on it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final, final

import numpy as np
from scipy.spatial import cKDTree

from bladecad.arrays import Array, Vector, seal

BETWEEN = 8  # samples a step in which the search for a foot begins
NEWTON = 12
STRAIGHT: Final = 0.5  # cosine between step and tangent: it crosses a corner, a cut-off edge


@final
@dataclass(frozen=True, eq=False)
class OutlineCurve:
    """Hermite cubics through the points of a loop, square to the normals there.

    points  : (n, 2) float, mm, in order, the first not repeated
    normals : (n, 2) float, unit, out of the metal

    A step that leaves or meets its ends at more than 60 degrees crosses the corner of a cut-off
    edge, and is straight.
    """

    points: Array
    normals: Array

    def __post_init__(self) -> None:
        n = len(self.points)
        seal(self, points=(n, 2), normals=(n, 2))

    @cached_property
    def length(self) -> Vector:
        """Length of outline that each point stands for, (n,), mm."""
        step = np.linalg.norm(self._step, axis=1)
        return np.asarray(0.5 * (step + np.roll(step, 1)))

    def __call__(self, x: Vector, order: int = 0) -> Array:
        """The point at x, or a derivative: k + s on step k, s from 0 to 1; (m, 2)."""
        k, s = np.floor(x).astype(int) % len(self.points), x - np.floor(x)
        powers = [np.prod(np.arange(j, j - order, -1.0)) * s ** max(j - order, 0) for j in range(4)]
        return np.asarray(np.einsum("jm,mjx->mx", np.array(powers), self._cubic[k]))

    def foot(self, q: Array) -> tuple[Vector, Array]:
        """Distance, positive outside, and the outward normal at the foot; (m,) and (m, 2)."""
        x = np.asarray(self._tree.query(q)[1]) / BETWEEN
        for _ in range(NEWTON):
            away, X1, X2 = self(x) - q, self(x, 1), self(x, 2)
            square = np.einsum("mx,mx->m", X1, X1)
            bend = np.maximum(square + np.einsum("mx,mx->m", away, X2), 0.1 * square)
            x = x - np.clip(np.einsum("mx,mx->m", away, X1) / bend, -0.3, 0.3)
        T = self(x, 1)
        N = self._turn * np.column_stack([T[:, 1], -T[:, 0]])
        N = N / np.linalg.norm(N, axis=1, keepdims=True)
        return np.einsum("mx,mx->m", q - self(x), N), N

    @cached_property
    def _step(self) -> Array:
        return np.asarray(np.roll(self.points, -1, axis=0) - self.points)

    @cached_property
    def _turn(self) -> float:
        """1 where the loop has the metal on its left, else -1."""
        right = np.column_stack([self._step[:, 1], -self._step[:, 0]])
        return 1.0 if np.einsum("nx,nx->", right, self.normals) > 0 else -1.0

    @cached_property
    def _cubic(self) -> Array:
        """Coefficients of every step, (n, 4, 2)."""
        h = self._step
        size = np.linalg.norm(h, axis=1, keepdims=True)
        left = self._turn * np.column_stack([-self.normals[:, 1], self.normals[:, 0]])
        a, b = left * size, np.roll(left, -1, axis=0) * size
        along = np.minimum(np.sum(a * h, axis=1), np.sum(b * h, axis=1))
        corner = along < STRAIGHT * size[:, 0] ** 2
        a, b = (np.where(corner[:, None], h, tangent) for tangent in (a, b))
        return np.stack([self.points, a, 3.0 * h - 2.0 * a - b, a + b - 2.0 * h], axis=1)

    @cached_property
    def _tree(self) -> cKDTree:
        return cKDTree(self(np.arange(len(self.points) * BETWEEN) / BETWEEN))
