"""A blade between its end walls: cut where it crosses them, continued where it falls short."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal, final

import numpy as np

from bladecad.arrays import Mask, Points, Vector
from bladecad.errors import DataError, GeometryError
from bladecad.passage.cylinder import to_cylinder
from bladecad.passage.walls import Wall
from bladecad.surface.blade import BladeSurface, SideName

WallName = Literal["hub", "shroud"]
WALLS: Final[tuple[WallName, WallName]] = ("hub", "shroud")

LIMIT: Final = 0.05  # of the span, how far the surface is continued
SCAN: Final = 45  # rows along the span on which a crossing is looked for
NEWTON: Final = 20
CLOSE: Final = 1e-9  # mm


@final
@dataclass(frozen=True, eq=False)
class Trimmed:
    """The blade between its walls, S((1 - v) u_h(t) + v u_t(t), t) with v from 0 to 1.

    surface  : the blade as it is
    axis     : column of the machine axis
    hub, shroud : Wall
    hub_gap, tip_gap : mm, between the wall and the end of the blade, along the wall's normal
    limit    : how far S may be continued beyond u = 0 and 1 by its own end polynomials
    """

    surface: BladeSurface
    axis: int
    hub: Wall
    shroud: Wall
    hub_gap: float = 0.0
    tip_gap: float = 0.0
    limit: float = LIMIT

    def gap(self, name: WallName) -> float:
        """Between a wall and the blade, mm."""
        return self.hub_gap if name == "hub" else self.tip_gap

    def wall(self, name: WallName) -> Wall:
        """One of the two."""
        return self.hub if name == "hub" else self.shroud

    def cut(self, name: WallName, side: SideName, t: Vector) -> tuple[Vector, float]:
        """Find u where the side meets a wall (less its gap), at every t.

        Returns
        -------
        u : (len(t),) float
        error : float
            Largest distance of S(u(t), t) from the wall (less its gap), measured, mm.

        Raises
        ------
        DataError
            Where the blade does not cross the wall even if continued, or the wall ends before it.

        Notes
        -----
        Newton on the height h(u) of S(u,t) over the wall, dh/du = n . S_u, from the last change of
        sign towards the middle of the blade.
        """
        t = np.asarray(t, dtype=np.float64)
        low, high = self._bracket(name, side, t)
        u = 0.5 * (low + high)
        for _ in range(NEWTON):
            f, slope, _ = self._height(name, side, u, t)
            if np.abs(f).max() < 1e-3 * CLOSE:
                break
            below = f <= 0.0 if name == "hub" else f > 0.0
            low, high = np.where(below, u, low), np.where(below, high, u)
            step = np.divide(-f, slope, out=np.zeros_like(f), where=slope != 0)
            inside = (u + step >= low) & (u + step <= high)
            u = np.where(inside, u + step, 0.5 * (low + high))
        f, _, s = self._height(name, side, u, t)
        self._check_ends(name, side, u, t, s)
        error = float(np.abs(f).max())
        if error > CLOSE:
            raise GeometryError(
                f"the {side} side is cut {error:.3g} mm off the {name}, {CLOSE:g} mm are allowed; "
                "look for a fold of the wall or the blade"
            )
        return u, error

    def ends(self, side: SideName, t: Vector) -> tuple[Vector, Vector]:
        """u at the hub and at the tip for every t, (len(t),) each."""
        low, high = (self.cut(name, side, t)[0] for name in ("hub", "shroud"))
        if np.any(low >= high):
            k = int(np.argmax(low - high))
            raise DataError(
                f"nothing of the {side} side is left between hub and shroud at t = {t[k]:.3f}; "
                "the blade does not cross the passage: look at the walls and their unit"
            )
        return low, high

    def at(self, side: SideName, v: Vector, t: Vector) -> Points:
        """Points at the places (v_k, t_k), (k, 3) mm."""
        distinct, which = np.unique(t, return_inverse=True)
        low, high = (end[which] for end in self.ends(side, distinct))
        return self.surface.at(side, (1.0 - v) * low + v * high, t)

    def _bracket(self, name: WallName, side: SideName, t: Vector) -> tuple[Vector, Vector]:
        u = np.linspace(-self.limit, 1.0 + self.limit, SCAN)
        zr = to_cylinder(self.surface(side, u, t), self.axis)[..., :2]
        f = self.wall(name).height(zr.reshape(-1, 2))[0].reshape(len(u), len(t)) - self.gap(name)
        if name == "shroud":
            u, f = u[::-1], f[::-1]
        crossing = (f[:-1] <= 0) & (f[1:] > 0)
        missed = np.asarray(~crossing.any(axis=0))
        if missed.any():
            raise DataError(self._missed(name, side, f[0], t, missed))
        last = len(u) - 2 - np.argmax(crossing[::-1], axis=0)
        ends = np.sort([u[last], u[last + 1]], axis=0)
        return ends[0], ends[1]

    def _missed(
        self, name: WallName, side: SideName, first: Vector, t: Vector, missed: Mask
    ) -> str:
        k = int(np.argmax(np.where(missed, np.abs(first), -1.0)))
        if first[k] < 0:
            return (
                f"the {side} side lies beyond the {name} at t = {t[k]:.3f}, from root to tip; the "
                "blade does not cross the passage: look at the walls and their unit"
            )
        return (
            f"the {side} side falls short of the {name} at t = {t[k]:.3f}: {first[k]:.4g} mm are "
            f"missing though it is continued by {100 * self.limit:g} % of the span; "
            "look at the walls, or give a blade that reaches them"
        )

    def _height(
        self, name: WallName, side: SideName, u: Vector, t: Vector
    ) -> tuple[Vector, Vector, Vector]:
        """Height over wall and gap, its derivative by u, and s of the nearest place."""
        X, Xu = self.surface.at(side, u, t), self.surface.at(side, u, t, 1, 0)
        wall = self.wall(name)
        height, s = wall.height(to_cylinder(X, self.axis)[:, :2])
        i, j = (self.axis + 1) % 3, (self.axis + 2) % 3
        r_u = (X[:, i] * Xu[:, i] + X[:, j] * Xu[:, j]) / np.hypot(X[:, i], X[:, j])
        slope = np.einsum("kx,kx->k", wall.normal(s), np.column_stack([Xu[:, self.axis], r_u]))
        return height - self.gap(name), slope, s

    def _check_ends(self, name: WallName, side: SideName, u: Vector, t: Vector, s: Vector) -> None:
        wall = self.wall(name)
        beyond = (s <= 0.0) | (s >= wall.nodes[-1])
        if beyond.any():
            k = int(np.argmax(beyond))
            z, r = to_cylinder(self.surface.at(side, u[[k]], t[[k]]), self.axis)[0, :2]
            end = wall.points[0 if s[k] <= 0.0 else -1]
            raise DataError(
                f"the {name} ends at axial position {end[0]:.6g} mm, radius {end[1]:.6g} mm, "
                f"before the blade does, at {z:.6g} mm, {r:.6g} mm; give walls that reach further"
            )
