"""A section of the nominal: its outline in space and in the flat, and how deviation moves it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Mask, Points, Vector, seal
from bladecad.curves.develop import MERIDIAN_DEGREE, cylindrical, develop, frame
from bladecad.surface.blade import BladeSurface, EdgeKind, SideName, normals

SAMPLES: Final = 241  # a side
GRADING: Final = 3.0  # ends of the tanh that places them: 60 times denser at the edges
STEEPEST: Final = 0.3  # sine between skin and section below which the section tells nothing


@final
@dataclass(frozen=True, eq=False)
class Station:
    """The outline of a nominal section, a loop from the leading edge along the suction side.

    name, u     : of the station
    t, suction  : (n,) place and side of each point
    points      : (n, 3) float, mm
    normal      : (n, 3) float, unit normals of the blade, out of the metal
    flat        : (n, 2) float, mm; the loop laid flat, first column along the machine axis
    flat_normal : (n, 2) float, unit normals of the loop there
    scale       : (n,) float, true length over flat length
    stretch     : (n,) float, how far the loop moves in the flat for 1 mm of deviation: the skin
                  may lean against the surface of the section
    arc         : (n,) float, mm along the loop; the faces of cut-off edges are part of it
    perimeter   : mm, all round
    le, te      : kind of the edges
    """

    name: str
    u: float
    t: Vector
    suction: Mask
    points: Points
    normal: Points
    flat: Points
    flat_normal: Points
    scale: Vector
    stretch: Vector
    arc: Vector
    perimeter: float
    le: EdgeKind
    te: EdgeKind

    def __post_init__(self) -> None:
        n = len(self.t)
        seal(self, points=(n, 3), normal=(n, 3), flat=(n, 2), flat_normal=(n, 2), t=(n,))
        seal(self, scale=(n,), stretch=(n,), arc=(n,))

    @cached_property
    def lengths(self) -> Vector:
        """Length of the loop that each point stands for, (n,), mm."""
        steps = np.linalg.norm(np.diff(self.points, axis=0, append=self.points[:1]), axis=1)
        return np.asarray(0.5 * (steps + np.roll(steps, 1)))

    @property
    def te_arc(self) -> float:
        """Arc at the trailing edge; at the middle of its face if it is cut off."""
        return float(0.5 * (self.arc[SAMPLES - 1] + self._pressure_arc()[-1]))

    def arc_of(self, suction: Mask, t: Vector) -> Vector:
        """Arc of places on the two sides, (k,), mm."""
        grid = places()
        along = np.interp(t, grid, self.arc[:SAMPLES])
        return np.where(suction, along, np.interp(t, grid, self._pressure_arc()))

    def side(self, name: SideName) -> NDArray[np.intp]:
        """Numbers of the points of one side from the leading to the trailing edge."""
        if name == "suction":
            return np.arange(SAMPLES)
        n = len(self.t)
        back = np.arange(n - 1, SAMPLES - 1, -1)
        at_le = back[:0] if self.le == "blunt" else np.array([0])
        at_te = back[:0] if self.te == "blunt" else np.array([SAMPLES - 1])
        return np.concatenate([at_le, back, at_te])

    def _pressure_arc(self) -> Vector:
        arc = self.arc[self.side("pressure")]
        if self.le != "blunt":
            arc[0] = self.perimeter
        return np.asarray(arc)


def places() -> Vector:
    """Chordwise places of the samples of a side, dense at both edges, (SAMPLES,)."""
    x = np.tanh(GRADING * np.linspace(-1.0, 1.0, SAMPLES)) / np.tanh(GRADING)
    t = 0.5 * (1.0 + x)
    t[0], t[-1] = 0.0, 1.0
    return np.asarray(t)


def stations_at(surface: BladeSurface, u: Mapping[str, float], axis: int) -> list[Station]:
    """Cut the nominal along lines of constant u, each in its plane or surface of revolution.

    Parameters
    ----------
    u : names and u of the stations
    axis : {0, 1, 2}
        Column of the machine axis.
    """
    t, at = places(), np.array([*u.values()])
    back = t[None if surface.te == "blunt" else -2 : None if surface.le == "blunt" else 0 : -1]
    S, P = surface("suction", at, t), surface("pressure", at, back)
    N, M = normals(surface, "suction", at, t), normals(surface, "pressure", at, back)
    points, normal = np.concatenate([S, P], axis=1), np.concatenate([N, M], axis=1)
    t = np.concatenate([t, back])
    return [
        _station(surface, name, float(at[k]), t, points[k], normal[k], axis)
        for k, name in enumerate(u)
    ]


def _station(
    surface: BladeSurface, name: str, u: float, t: Vector, points: Points, normal: Points, axis: int
) -> Station:
    laid = develop(points, axis)
    lean = np.abs(np.einsum("nx,nx->n", normal, _across(points, laid.kind, axis)))
    stretch = 1.0 / (np.sqrt(np.maximum(1.0 - lean**2, STEEPEST**2)) * laid.scale)
    steps = np.linalg.norm(np.diff(points, axis=0, append=points[:1]), axis=1)
    closing = 0.5 * float(steps[-1]) if surface.le == "blunt" else 0.0
    arc = closing + np.concatenate([[0.0], np.cumsum(steps[:-1])])
    suction = np.arange(len(points)) < SAMPLES
    return Station(
        name, u, t, suction, points, normal,
        laid.points, _flat_normals(laid.points, surface), laid.scale, stretch,
        arc, float(steps.sum()), surface.le, surface.te,
    )  # fmt: skip


def _across(points: Points, kind: str, axis: int) -> Array:
    """Unit normals of the plane or surface of revolution that holds the section, (n, 3)."""
    if kind == "plane":
        return np.broadcast_to(frame(points)[1][2], points.shape)
    z, r, theta = cylindrical(points, axis)
    zr = np.column_stack([z, r])
    centre, (e, n), _ = frame(zr)
    x, y = (zr - centre) @ e, (zr - centre) @ n
    slope = np.polynomial.Polynomial.fit(x, y, MERIDIAN_DEGREE).deriv()(x)
    along, out = (n[:, None] - slope * e[:, None]) / np.hypot(1.0, slope)
    across = np.column_stack([along, out * np.cos(theta), out * np.sin(theta)])
    return np.asarray(np.roll(across, axis, axis=1))


def _flat_normals(flat: Points, surface: BladeSurface) -> Points:
    """Unit normals of the loop, outwards; at the corners of a cut-off edge those of the sides."""
    tangent = np.empty_like(flat)
    n = len(flat)
    for side in (np.arange(SAMPLES), np.arange(SAMPLES, n)):
        around = np.concatenate([[side[0] - 1], side, [(side[-1] + 1) % n]])
        tangent[side] = _central(flat[around])
    if surface.te == "blunt":
        tangent[SAMPLES - 1] = flat[SAMPLES - 1] - flat[SAMPLES - 2]
        tangent[SAMPLES] = flat[SAMPLES + 1] - flat[SAMPLES]
    if surface.le == "blunt":
        tangent[0], tangent[-1] = flat[1] - flat[0], flat[-1] - flat[-2]
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    x, y = flat.T
    hand = np.sign(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
    return np.asarray(hand * np.column_stack([tangent[:, 1], -tangent[:, 0]]))


def _central(x: Points) -> Points:
    """Derivative along a line by the parabola through each point and its neighbours."""
    steps = np.linalg.norm(np.diff(x, axis=0), axis=1)[:, None]
    slopes = np.diff(x, axis=0) / steps
    before, after = steps[:-1], steps[1:]
    return np.asarray((slopes[:-1] * after + slopes[1:] * before) / (before + after))
