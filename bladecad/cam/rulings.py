"""Straight lines from hub to tip, and how their distance from a side changes as they move."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from bladecad.arrays import Array, Vector
from bladecad.deviation.nearest.skin import Found, Skin, search, skin_of
from bladecad.deviation.nearest.squares import cut
from bladecad.surface.blade import BladeSurface, SideName, outward
from bladecad.surface.loft import first_breaks

ALONG: Final = 41  # places on a ruling
CLOSEST: Final = 0.1  # of their distance at the hub: as near as rulings may come at the tip
V: Final = np.linspace(0.0, 1.0, ALONG)
WEIGHT: Final = np.where((V == 0.0) | (V == 1.0), 0.5**0.5, 1.0)[:, None]  # trapezoidal rule


@final
@dataclass(frozen=True, eq=False)
class Rulings:
    """Rulings by coefficients c, (3, q): alpha, b - t and beta are M c.

    skin : the side alone, lest the foot of a ruling falls through to the other
    t    : (k,) float, where rulings start at the hub
    M    : (k, q) float, splines there
    """

    surface: BladeSurface
    side: SideName
    skin: Skin
    t: Vector
    M: Array

    def laid(self, c: Array) -> tuple[Array, Array, Array, Array, Array]:
        """Points (m, k, 3), and at hub and tip normals, tangents and b, each (k, 3) or (k,)."""
        alpha, slid, beta = c @ self.M.T
        b = self.t + slid
        n0, n1 = (
            _normals(self.surface, self.side, 0.0, self.t),
            _normals(self.surface, self.side, 1.0, b),
        )
        S0, S1 = (
            self.surface.at(self.side, np.full(len(x), u), x) for u, x in ((0.0, self.t), (1.0, b))
        )
        v = V[:, None, None]
        X = (1.0 - v) * (S0 + alpha[:, None] * n0) + v * (S1 + beta[:, None] * n1)
        return X, n0, n1, self.surface.at(self.side, np.ones(len(b)), b, 0, 1), b

    def linear(self, c: Array) -> tuple[Vector, Array, Array]:
        """Weighted distance of the rulings, its Jacobian, and that of how far ends slide, mm."""
        X, n0, n1, along, _ = self.laid(c)
        found = search(self.skin, X.reshape(-1, 3))
        n, v = found.normal.reshape(X.shape), V[:, None]
        ways = ((1.0 - v, n0), (v, along), (v, n1))
        columns = [WEIGHT * w * np.einsum("kx,mkx->mk", way, n) for w, way in ways]
        J = np.stack([a[:, :, None] * self.M for a in columns], axis=2)
        hold = np.zeros((len(self.t), 3, self.M.shape[1]))
        hold[:, 1] = np.sqrt(ALONG) * np.linalg.norm(along, axis=1)[:, None] * self.M
        r = (WEIGHT * found.distance.reshape(X.shape[:2])).ravel()
        return r, J.reshape(len(r), -1), hold.reshape(len(hold), -1)

    def step(self, c: Array, r: Vector, J: Array, hold: Array, damping: float) -> Array:
        """The step of least squares of the distance, sliding damped, ends of b held."""
        free = np.ones(c.shape, bool)
        free[1, [0, -1]] = False
        J, hold = J[:, free.ravel()], hold[:, free.ravel()]
        step = np.zeros(c.size)
        normal = J.T @ J + damping**2 * hold.T @ hold
        step[free.ravel()] = -np.linalg.lstsq(normal, J.T @ r, rcond=None)[0]
        return step.reshape(c.shape)

    def t_of(self, found: Found) -> Vector:
        """Chordwise place of feet."""
        t0, t1 = self.skin.squares.domain[found.item][:, 2:].T
        return np.asarray(t0 + t1 * found.place[:, 1])

    def in_order(self, c: Array) -> bool:
        """Whether rulings stay apart at the tip."""
        return bool(np.all(np.diff(self.t + c[1] @ self.M.T) > CLOSEST * np.diff(self.t)))


def side_skin(surface: BladeSurface, side: SideName) -> Skin:
    """The skin of one side alone."""
    u, t = np.unique(surface.knots[0]), first_breaks(surface)
    sign = outward(surface, side)
    return skin_of(cut(lambda u, t: surface(side, u, t), u, t, face=0, sign=sign))


def _normals(surface: BladeSurface, side: SideName, u: float, t: Vector) -> Array:
    at = np.full(len(t), u), t
    n = outward(surface, side) * np.cross(surface.at(side, *at, 1, 0), surface.at(side, *at, 0, 1))
    return np.asarray(n / np.linalg.norm(n, axis=1)[:, None])
