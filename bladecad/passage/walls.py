"""End walls: meridional curves r(z) of hub and shroud, and where points are beside them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final, final

import numpy as np
from scipy.interpolate import BSpline
from scipy.spatial import cKDTree

from bladecad.arrays import Array, Vector, frozen, seal
from bladecad.errors import DataError
from bladecad.splines import basis, not_a_knot

DENSE: Final = 24  # places in every span of the spline
NEWTON: Final = 12  # steps to the nearest place
SETTLED: Final = 1e-9  # mm; the next Newton step is its square
SAME: Final = 1e-6  # mm; points this close are one


@final
@dataclass(frozen=True, eq=False)
class Wall:
    """An end wall, the C2 spline through its points, swept round the axis.

    name   : "hub" or "shroud"
    points : (n, 2) float, mm; axial position and radius, inlet to outlet
    side   : +1 where the fluid lies to the left of the curve, -1 to the right

    The parameter s is the length along the chords of the points, mm.
    """

    name: str
    points: Array
    side: float

    def __post_init__(self) -> None:
        seal(self, points=(None, 2))

    @cached_property
    def nodes(self) -> Vector:
        """Parameter of every point, (n,) mm."""
        steps = np.linalg.norm(np.diff(self.points, axis=0), axis=1)
        return frozen(np.concatenate([[0.0], np.cumsum(steps)]))

    @cached_property
    def spline(self) -> tuple[BSpline, BSpline, BSpline]:
        """The curve and its first two derivatives by s."""
        knots, degree = not_a_knot(self.nodes)
        poles = np.linalg.solve(basis(knots, degree, self.nodes), self.points)
        slope = _derivative(curve := BSpline(knots, poles, degree))
        return curve, slope, _derivative(slope)

    @cached_property
    def table(self) -> tuple[Vector, Vector, Vector]:
        """Dense s, the length along the wall, and m = integral of ds / r there."""
        inner = np.linspace(0.0, 1.0, DENSE, endpoint=False)
        s = self.nodes[:-1, None] + np.diff(self.nodes)[:, None] * inner
        s = np.append(s.ravel(), self.nodes[-1])
        zr = self(s)
        steps = np.linalg.norm(np.diff(zr, axis=0), axis=1)
        mean = 0.5 * (zr[1:, 1] + zr[:-1, 1])
        length, m = (np.append(0.0, np.cumsum(d)) for d in (steps, steps / mean))
        return frozen(s), frozen(length), frozen(m)

    @cached_property
    def tree(self) -> cKDTree:
        """Search tree over the dense places."""
        return cKDTree(self(self.table[0]))

    def __call__(self, s: Vector, order: int = 0) -> Array:
        """Axial position and radius at s, or a derivative by s, (k, 2)."""
        return np.asarray(self.spline[order](np.asarray(s, dtype=np.float64)))

    def normal(self, s: Vector) -> Array:
        """Unit normal into the fluid, (k, 2)."""
        T = self(s, 1)
        T = T / np.linalg.norm(T, axis=1, keepdims=True)
        return np.asarray(self.side * np.column_stack([-T[:, 1], T[:, 0]]))

    def above(self, s: Vector, gap: float) -> Array:
        """Places at a distance from the wall, into the fluid, (k, 2) mm."""
        return np.asarray(self(s) + gap * self.normal(s))

    def nearest(self, zr: Array) -> Vector:
        """Parameter of the nearest place of the wall, (k,); its end where that is nearest."""
        s = self.table[0][self.tree.query(zr)[1]]
        for _ in range(NEWTON):
            away, T, N = self(s) - zr, self(s, 1), self(s, 2)
            slope = np.einsum("kx,kx->k", T, T)
            bend = slope + np.einsum("kx,kx->k", away, N)
            bend = np.where(bend > 0.2 * slope, bend, slope)
            step = np.einsum("kx,kx->k", away, T) / bend
            s = np.clip(s - step, 0.0, self.nodes[-1])
            if np.abs(step).max(initial=0.0) < SETTLED:
                break
        return s

    def height(self, zr: Array) -> tuple[Vector, Vector]:
        """Distance of points from the wall, positive in the fluid, and the nearest s."""
        s = self.nearest(zr)
        return np.einsum("kx,kx->k", zr - self(s), self.normal(s)), s


def walls(hub: Array, shroud: Array) -> tuple[Wall, Wall]:
    """Make hub and shroud of their points.

    Parameters
    ----------
    hub, shroud : (n, 2) float, mm
        Axial position and radius, both in the same direction.

    Raises
    ------
    DataError
        If a wall has fewer than two points or a radius not above 0, or the hub is above the shroud.
    """
    clean = [_checked(name, zr) for name, zr in (("hub", hub), ("shroud", shroud))]
    _check_order(*clean)
    between = _middle(clean[1]) - _middle(clean[0])
    pair = [Wall("hub", clean[0], _left(clean[0], between))]
    return pair[0], Wall("shroud", clean[1], _left(clean[1], -between))


def turned_round(wall: Wall) -> Wall:
    """The same wall from its other end."""
    return Wall(wall.name, wall.points[::-1], -wall.side)


def _checked(name: str, zr: Array) -> Array:
    zr = np.asarray(zr, dtype=np.float64).reshape(-1, 2)
    steps = np.linalg.norm(np.diff(zr, axis=0), axis=1)
    zr = np.concatenate([zr[:1], zr[1:][steps > SAME]])
    if len(zr) < 2:
        raise DataError(
            f"the {name} has {len(zr) or 'no'} point{'' if len(zr) == 1 else 's'}, 2 are needed; "
            "give hub and shroud with the blade or by --walls"
        )
    if zr[:, 1].min() <= 0.0:
        i = int(zr[:, 1].argmin())
        raise DataError(
            f"the {name} has a radius of {zr[i, 1]:g} mm at point {i + 1}, it must be above 0; "
            "end it before the axis"
        )
    return zr


def _check_order(hub: Array, shroud: Array) -> None:
    """Where both run along the axis, the shroud must be further out."""
    low, high = max(hub[:, 0].min(), shroud[:, 0].min()), min(hub[:, 0].max(), shroud[:, 0].max())
    if not (low < high and _along(hub) and _along(shroud)):
        return
    z = np.linspace(low, high, 401)
    r_hub, r_shroud = (np.interp(z, *w[np.argsort(w[:, 0])].T) for w in (hub, shroud))
    worst = int(np.argmin(r_shroud - r_hub))
    if r_shroud[worst] <= r_hub[worst]:
        raise DataError(
            f"the hub is above the shroud: radius {r_hub[worst]:.6g} mm against "
            f"{r_shroud[worst]:.6g} mm at axial position {z[worst]:.6g} mm; "
            "look whether the two are exchanged"
        )


def _derivative(curve: BSpline) -> BSpline:
    if curve.k:
        return curve.derivative()
    return BSpline(curve.t, np.zeros_like(curve.c), 0)


def _along(zr: Array) -> bool:
    steps = np.diff(zr[:, 0])
    return bool(np.all(steps > 0) or np.all(steps < 0))


def _middle(zr: Array) -> Vector:
    """Centroid of a line: points may lie closer in a bend."""
    length = np.linalg.norm(np.diff(zr, axis=0), axis=1)
    return np.average(0.5 * (zr[1:] + zr[:-1]), axis=0, weights=length)


def _left(zr: Array, towards: Vector) -> float:
    """+1 if `towards` looks to the left of the curve, by its middle."""
    T = zr[-1] - zr[0]
    return 1.0 if T[0] * towards[1] - T[1] * towards[0] > 0 else -1.0
