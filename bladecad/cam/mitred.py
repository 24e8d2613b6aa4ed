"""Parallel sides that run on past a cut-off edge, or end before it: its face is offset, too."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final, final

import numpy as np
from scipy.interpolate import CubicSpline

from bladecad.arrays import Array, Vector
from bladecad.cam.parallel import Parallel
from bladecad.errors import GeometryError
from bladecad.surface.blade import BladeSurface, SideName
from bladecad.surface.loft import SIDES

NODES: Final = 8  # a section, at which the mitre is found
NEWTON: Final = 8
LONGEST: Final = 3.0  # times the offset; an edge whose mitre is longer is too acute
ENDS: Final = (0.0, 1.0)


@final
@dataclass(frozen=True, eq=False)
class Mitred:
    """A parallel surface on t from 0 to 1, of which s_0(u) .. s_1(u) is taken, straight beyond.

    At a round edge s is 0 or 1. At a cut-off one it is where O, continued along its tangent, meets
    the plane parallel to the face of the edge: (O(u,s) - S(u,end)) . m = d, m its normal.
    """

    parallel: Parallel

    def __call__(self, name: SideName, u: Vector, t: Vector, most: int) -> Array:
        """O and its derivatives along t on the grid u x t, (most + 1, len(u), len(t), 3)."""
        if not self.cut_off:
            return self.parallel.derivatives(name, u, t, most)
        s0, s1 = self.limits(name, u)
        rows = [
            self._row(name, u[i : i + 1], s0[i] + (s1[i] - s0[i]) * t, most)
            * (s1[i] - s0[i]) ** np.arange(most + 1)[:, None, None, None]
            for i in range(len(u))
        ]
        return np.concatenate(rows, axis=1)

    def limits(self, name: SideName, u: Vector) -> tuple[Vector, Vector]:
        """s_0 and s_1 at some u, (len(u),) each."""
        s0, s1 = (spline(u) for spline in self._splines[name])
        return s0, s1

    @property
    def cut_off(self) -> bool:
        """Whether an edge is blunt."""
        surface = self.parallel.surface
        return "blunt" in (surface.le, surface.te)

    @cached_property
    def _splines(self) -> dict[SideName, tuple[CubicSpline, CubicSpline]]:
        surface = self.parallel.surface
        kinds = (surface.le, surface.te)
        u = np.linspace(0.0, 1.0, NODES * len(surface.span) + 1)
        found = {}
        for name in SIDES:
            s = [
                self._mitre(name, u, end) if kind == "blunt" else np.full(len(u), end)
                for end, kind in zip(ENDS, kinds, strict=True)
            ]
            found[name] = (CubicSpline(u, s[0]), CubicSpline(u, s[1]))
        return found

    def _mitre(self, name: SideName, u: Vector, end: float) -> Vector:
        """Where the side meets the plane of the edge's face, by Newton's method, at every u."""
        corner = self.parallel.surface(name, u, np.array([end]))[:, 0]
        m, s, d = self._face_normal(name, u, end), np.full(len(u), end), self.parallel.distance
        for _ in range(NEWTON):
            rows = [self._row(name, u[[i]], s[[i]], 1)[:, 0, 0] for i in range(len(u))]
            X, T = np.array(rows).transpose(1, 0, 2)
            s = s - (np.einsum("ux,ux->u", X - corner, m) - d) / np.einsum("ux,ux->u", T, m)
        length = np.abs(s - end) * np.linalg.norm(T, axis=1)
        worst = int(length.argmax())
        if not length[worst] <= LONGEST * abs(d):
            edge = "trailing" if end else "leading"
            raise GeometryError(
                f"the {name} side meets the face of the {edge} edge at u = {u[worst]:.3f} at so "
                f"acute an angle that its offset would end {length[worst]:.3g} mm away, "
                f"{LONGEST:g} times {abs(d):g} mm at most; give the edge a radius first"
            )
        return s

    def _face_normal(self, name: SideName, u: Vector, end: float) -> Array:
        """Unit normal of the edge's face at its border with a side, out of the metal, (k, 3)."""
        at, surface = np.array([end]), self.parallel.surface
        other: SideName = "pressure" if name == "suction" else "suction"
        across = surface(other, u, at)[:, 0] - surface(name, u, at)[:, 0]
        m = np.cross(surface(name, u, at, 1, 0)[:, 0], across)
        along = surface(name, u, at, 0, 1)[:, 0] * (2.0 * end - 1.0)
        m = m * np.sign(np.einsum("ux,ux->u", m, along))[:, None]
        return np.asarray(m / np.linalg.norm(m, axis=1)[:, None])

    def _row(self, name: SideName, u: Vector, s: Vector, most: int) -> Array:
        """O of one row, straight outside 0 .. 1; (most + 1, 1, len(s), 3)."""
        inside = np.clip(s, *ENDS)
        X = self.parallel.derivatives(name, u, inside, max(most, 1))
        past = (s - inside)[:, None]
        X[0] = X[0] + past * X[1]
        X[2:] = np.where(past != 0.0, 0.0, X[2:])
        return np.asarray(X[: most + 1])


def mitred(surface: BladeSurface, distance: float) -> Mitred:
    """Return the parallel surface of a blade, its cut-off edges mitred."""
    return Mitred(Parallel(surface, distance))
