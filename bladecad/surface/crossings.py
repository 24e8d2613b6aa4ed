"""Where lines of constant t cross a plane or a cylinder."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from bladecad.arrays import Array, Points, Vector
from bladecad.errors import GeometryError
from bladecad.surface.blade import BladeSurface, SideName
from bladecad.surface.levels import Level
from bladecad.surface.loft import SIDES, graded

STEPS: Final = 60  # Newton needs five; halving alone would need fifty
SETTLED: Final = 1e-13  # of the span
ROWS: Final = 65  # of u, on which the blade is seen to rise
PLACES: Final = 401  # of t


@final
@dataclass(frozen=True, eq=False)
class Rise:
    """How a blade rises through the level surfaces, hub to tip.

    level  : planes or cylinders
    sign   : 1 where heights grow from hub to tip, -1 where they fall
    lowest, highest : of all points of the blade, mm
    first, last     : heights between which it is cut from edge to edge, hub first; the first is
                      beyond the last where no level surface does
    """

    level: Level
    sign: float
    lowest: float
    highest: float
    first: float
    last: float

    def up(self, X: Points) -> Vector:
        """Heights that grow from hub to tip, mm."""
        return np.asarray(self.sign * self.level.height(X))

    @property
    def range(self) -> str:
        """From where to where the blade is cut from edge to edge, as the user is told."""
        low, high = sorted((self.first, self.last))
        return f"from edge to edge it is cut from {low:.6g} to {high:.6g} mm"


def rise(surface: BladeSurface, level: Level) -> Rise:
    """See how a blade rises through planes or cylinders.

    Raises
    ------
    GeometryError
        If it does not rise everywhere, so that one of them would cut it twice; or if none cuts it
        from edge to edge.
    """
    u, t = np.linspace(0.0, 1.0, ROWS), graded(PLACES)
    heights = np.concatenate([level.height(surface(s, u, t)).T for s in SIDES])
    sign = 1.0 if heights[:, -1].mean() >= heights[:, 0].mean() else -1.0
    up = sign * heights
    steps = np.diff(up, axis=1)
    place, row = np.unravel_index(steps.argmin(), steps.shape)
    if steps[place, row] <= 0:
        raise GeometryError(
            f"a {level.what} = const cuts the blade twice: it falls back by "
            f"{-steps[place, row]:.3g} mm near u = {u[row]:.2f}, t = {t[place % PLACES]:.2f}; cut "
            "it along streams, or by planes square to another direction"
        )
    first, last = up[:, 0].max(), up[:, -1].min()
    if first >= last:
        raise GeometryError(
            f"no {level.what} = const cuts the blade from edge to edge: the hub reaches to "
            f"{sign * first:.6g} mm and the tip begins at {sign * last:.6g} mm; cut it along "
            "streams, or by planes square to another direction"
        )
    ends = heights.min(), heights.max(), sign * first, sign * last
    return Rise(level, sign, *map(float, ends))


def crossings(
    surface: BladeSurface, name: SideName, rise: Rise, height: float, t: Vector, beyond: float = 0.0
) -> Vector:
    """Span u at which the lines t = const cross a level surface, (len(t),).

    Newton's method on height(S(u,t)), held between bounds that close in.

    Parameters
    ----------
    beyond : float
        Of the span, that u may lie outside 0 .. 1.

    Raises
    ------
    GeometryError
        If the surface misses the blade, or cuts only a part of it.
    """
    curves = surface.side(name)(t)
    low, high = np.full(len(t), -beyond), np.full(len(t), 1.0 + beyond)
    bottom, top = (rise.up(_at(surface, curves, u)) - rise.sign * height for u in (low, high))
    if bottom.max() > 0 or top.min() < 0:
        how = "cuts only a part of" if rise.lowest <= height <= rise.highest else "misses"
        raise GeometryError(f"{rise.level.what} = {height:.6g} mm {how} the blade; {rise.range}")
    u = low + (high - low) * bottom / (bottom - top)
    for _ in range(STEPS):
        X, dX = (_at(surface, curves, u, order) for order in (0, 1))
        away = rise.up(X) - rise.sign * height
        low, high = np.where(away < 0, u, low), np.where(away > 0, u, high)
        slope = rise.sign * np.einsum("kx,kx->k", rise.level.gradient(X), dX)
        newton = u - np.divide(away, slope, out=np.full_like(u, np.inf), where=slope > 0)
        new = np.where((newton >= low) & (newton <= high), newton, 0.5 * (low + high))
        settled = np.abs(new - u).max() <= SETTLED
        u = new
        if settled:
            break
    return np.asarray(u)


def _at(surface: BladeSurface, curves: Array, u: Vector, order: int = 0) -> Points:
    return np.asarray(np.einsum("ki,ikx->kx", surface.blend(u, order), curves))
