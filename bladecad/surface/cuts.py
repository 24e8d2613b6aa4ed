"""Sections of a surface: where planes, cylinders or its own stream surfaces cut it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal, TypeAlias

import numpy as np

from bladecad.arrays import Array, Points, Vector
from bladecad.errors import GeometryError, ToleranceError
from bladecad.surface.blade import BladeSurface, SideName, outward
from bladecad.surface.crossings import Rise, crossings, rise
from bladecad.surface.cut import Cut
from bladecad.surface.levels import Level
from bladecad.surface.loft import graded
from bladecad.surface.spread import spread, strayed

On = Literal["planes", "cylinders", "streams"]

FEWEST: Final = 8  # points of a section: three on each side and the two edges
MOST: Final = 20_000
MOST_SECTIONS: Final = 1_000
BEYOND: Final = 0.05  # of the span, that u may lie outside 0 .. 1
DENSE: Final = 1601  # places on a side, from which its points are chosen

Side: TypeAlias = tuple[Vector, Vector]  # u and t along one side


def cuts(
    surface: BladeSurface,
    level: Level | None,
    places: Sequence[float],
    *,
    points: int = 240,
    names: Sequence[str] | None = None,
) -> tuple[Cut, ...]:
    """Cut a surface into sections, hub first.

    Parameters
    ----------
    surface : BladeSurface
    level : Level, optional
        Planes or cylinders; None cuts along u = const, the stream surfaces of the input.
    places : sequence of float
        Height of each plane or radius of each cylinder, mm; u without a level. Beyond hub or tip
        the surface continues as its own end polynomials, up to 5 % of the span.
    points : int
        All round each section; they lie closest where the section is most curved.
    names : sequence of str, optional
        Of the sections, in the order of `places`; else letter and place, such as `r212.5`.

    Raises
    ------
    ToleranceError
        If there are fewer than 8 points or too many, or a place is given twice or is not finite.
    GeometryError
        If a place misses the blade or cuts only a part of it.
    """
    if points < FEWEST:
        raise ToleranceError(f"{points} points round a section; at least {FEWEST} are needed")
    if points > MOST or len(places) > MOST_SECTIONS:
        raise ToleranceError(
            f"{len(places)} sections of {points} points are asked; "
            f"{MOST_SECTIONS} of {MOST} at most"
        )
    ranked = sorted(places)
    if not np.isfinite(ranked).all() or np.any(np.diff(ranked) <= 0):
        raise ToleranceError(f"sections at {_list(places)}: each place once, and finite")
    letter = level.letter if level else "u"
    named = names or [f"{letter}{place:.6g}" for place in places]
    rising = None if level is None else rise(surface, level)
    found = [
        _cut(surface, rising, float(place), points, name)
        for place, name in zip(places, named, strict=True)
    ]
    return tuple(sorted(found, key=lambda cut: float(cut.u.mean())))


def evenly(surface: BladeSurface, level: Level | None, count: int) -> Vector:
    """Places of so many sections, evenly from the first to the last that cuts the whole blade.

    Raises
    ------
    ToleranceError
        If there are fewer than two.
    GeometryError
        If none cuts the whole blade.
    """
    if count > MOST_SECTIONS:
        raise ToleranceError(f"{count} stations are asked; {MOST_SECTIONS} at most")
    if count < 2:
        raise ToleranceError(
            f"{count} station{'s' * (count != 1)}; a file of sections needs 2 at least"
        )
    if level is None:
        return np.linspace(0.0, 1.0, count)
    rising = rise(surface, level)
    return np.linspace(rising.first, rising.last, count)


def _cut(surface: BladeSurface, rising: Rise | None, place: float, count: int, name: str) -> Cut:
    blunt = (surface.le == "blunt") + (surface.te == "blunt")
    gaps = count - blunt
    suction = _side(surface, "suction", rising, place, (gaps + 1) // 2)
    pressure = _side(surface, "pressure", rising, place, gaps // 2)
    back = slice(None if surface.te == "blunt" else -2, None if surface.le == "blunt" else 0, -1)
    n = len(suction[0])
    u, t = (np.concatenate([s, p[back]]) for s, p in zip(suction, pressure, strict=True))
    first = np.arange(len(t)) < n
    points = np.concatenate(
        [surface.at("suction", u[:n], t[:n]), surface.at("pressure", u[n:], t[n:])]
    )
    error = 0.0 if rising is None else float(np.abs(rising.level.height(points) - place).max())
    le = (len(t) - 1, 0) if surface.le == "blunt" else (0,)
    te = (n - 1, n) if surface.te == "blunt" else (n - 1,)
    return Cut(
        name, place, u, t, first, points, _normals(surface, u, t, n), le, te, error,
        _strayed(surface, rising, place, suction, pressure),
    )  # fmt: skip


def _side(
    surface: BladeSurface, name: SideName, rising: Rise | None, place: float, gaps: int
) -> Side:
    """Places along one side of a section, leading edge first."""
    dense = graded(DENSE)
    t = spread(surface.at(name, _u(surface, name, rising, place, dense), dense), dense, gaps)
    return _u(surface, name, rising, place, t), t


def _u(
    surface: BladeSurface, name: SideName, rising: Rise | None, place: float, t: Vector
) -> Vector:
    if rising is not None:
        return crossings(surface, name, rising, place, t, BEYOND)
    if not -BEYOND <= place <= 1.0 + BEYOND:
        raise GeometryError(
            f"section at u = {place:g} misses the blade: u runs from 0 at the hub to 1 at the tip, "
            f"and the surface is continued by {100 * BEYOND:g} % of the span at most"
        )
    return np.full(len(t), place)


def _normals(surface: BladeSurface, u: Vector, t: Vector, n: int) -> Points:
    """Unit normals at places, the first n on the suction side, out of the metal."""
    found: list[Array] = []
    sides: tuple[tuple[SideName, slice], ...] = (
        ("suction", slice(None, n)), ("pressure", slice(n, None)),
    )  # fmt: skip
    for name, part in sides:
        Su, St = (surface.at(name, u[part], t[part], *d) for d in ((1, 0), (0, 1)))
        N = np.cross(Su, St) * outward(surface, name)
        found.append(N / np.linalg.norm(N, axis=1, keepdims=True))
    return np.concatenate(found)


def _strayed(
    surface: BladeSurface, rising: Rise | None, place: float, suction: Side, pressure: Side
) -> float:
    """How far the spline through the points strays: one closed spline, or one a side at corners."""
    on: list[Array] = []
    middles: list[Array] = []
    for name, (u, t) in (("suction", suction), ("pressure", pressure)):
        side: SideName = "suction" if name == "suction" else "pressure"
        tm = 0.5 * (t[1:] + t[:-1])
        on.append(surface.at(side, u, t))
        middles.append(surface.at(side, _u(surface, side, rising, place, tm), tm))
    if surface.le == surface.te == "round":
        loop = np.concatenate([on[0][:-1], on[1][:0:-1]])
        return strayed(loop, np.concatenate([middles[0], middles[1][::-1]]), closed=True)
    return max(strayed(p, m, closed=False) for p, m in zip(on, middles, strict=True))


def _list(places: Sequence[float]) -> str:
    return ", ".join(f"{place:g}" for place in places)
