"""How large the triangles may be, and the steps along the chord and the span that follow."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final, final

import numpy as np

from bladecad.arrays import Array, Vector
from bladecad.errors import GeometryError, ToleranceError
from bladecad.surface.blade import BladeSurface, normals
from bladecad.surface.loft import SIDES, graded

ALONG_T: Final = 0.6  # share of the chord error that the step along the chord may use
TURN: Final = np.radians(20.0)  # of a section from one line to the next, at most
ACROSS: Final = 25  # spans at which steps along the chord are judged
DENSE: Final = 1601  # places along the chord
MOST: Final = 2_000_000  # points of a side


@final
@dataclass(frozen=True)
class Sizing:
    """What is asked of the triangles.

    size        : mm, largest step along chord and span
    chord_error : mm, largest distance of the triangles from the surface
    growth      : largest ratio of neighbouring steps along the chord
    edge        : mm, largest step at the leading and trailing edge; None leaves it to chord_error
    aspect      : how many times longer than wide the cells at the edges may be
    """

    size: float
    chord_error: float = 0.01
    growth: float = 1.2
    edge: float | None = None
    aspect: float = 4.0

    def __post_init__(self) -> None:
        for name, value in (("a size", self.size), ("a chord error", self.chord_error)):
            _positive(name, value)
        if self.edge is not None:
            _positive("an edge size", self.edge)
        for name, value in (("growth", self.growth), ("aspect", self.aspect)):
            if not (math.isfinite(value) and value > 1.0):
                raise ToleranceError(f"a {name} of {value:g} is asked; it must be above 1")


def _positive(name: str, value: float) -> None:
    if not (math.isfinite(value) and value > 0.0):
        raise ToleranceError(f"{name} of {value:g} mm is asked; it must be above 0")


def chordwise(surface: BladeSurface, sizing: Sizing) -> Vector:
    """Parameters t, from 0 to 1, whose steps are as long as they may be, nowhere longer.

    Notes
    -----
    A step h, in t, leaves the arc by |X_tt . n| h^2 / 8 and turns by |X_tt . n| h / |X_t|. From
    edge to body the steps grow as a geometric row does, |dh/dt| <= ln(growth), the same in t and
    in mm where |X_t| is even (Borouchaki, Hecht and Frey, Mesh gradation control, 1998).
    """
    t = graded(DENSE)
    h = _allowed(surface, t, sizing)
    h = _gradated(t, h, math.log(sizing.growth))
    return _placed(t, 1.0 / h)


def _allowed(surface: BladeSurface, t: Vector, sizing: Sizing) -> Vector:
    """Largest step in t, by size and by chord error, the least over both sides and the span."""
    u = np.linspace(0.0, 1.0, ACROSS)
    h = np.full(len(t), np.inf)
    for side in SIDES:
        speed = np.linalg.norm(surface(side, u, t, 0, 1), axis=2)
        X_tt, n = surface(side, u, t, 0, 2), normals(surface, side, u, t)
        bend = np.maximum(np.abs(np.einsum("utx,utx->ut", X_tt, n)), 1e-12)
        sagitta = np.sqrt(8.0 * ALONG_T * sizing.chord_error / bend)
        steps = np.stack([sizing.size / speed, sagitta, TURN * speed / bend])
        h = np.minimum(h, steps.min(axis=(0, 1)))
        if sizing.edge is not None:
            h[[0, -1]] = np.minimum(h[[0, -1]], sizing.edge / speed[:, [0, -1]].max(axis=0))
    return h


def _gradated(t: Vector, h: Vector, slope: float) -> Vector:
    """The largest function below h that nowhere rises or falls faster than the slope."""
    below = h - slope * t
    rising = np.minimum.accumulate(below) + slope * t
    falling = np.minimum.accumulate((rising + slope * t)[::-1])[::-1] - slope * t
    return np.asarray(np.minimum(rising, falling))


def _placed(t: Vector, density: Vector) -> Vector:
    """Places from 0 to 1 with no fewer steps per unit than the density."""
    mass = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(t))])
    if not mass[-1] <= MOST:
        raise GeometryError(
            f"{mass[-1]:.2g} lines along the span are asked, {MOST:,} at most; ask for larger"
        )
    count = max(math.ceil(mass[-1]), 8)
    places = np.interp(np.linspace(0.0, mass[-1], count + 1), mass, t)
    places[[0, -1]] = 0.0, 1.0
    return places


def spanwise(surface: BladeSurface, t: Vector, sizing: Sizing) -> list[Vector]:
    """Parameters u, from 0 to 1, on every line t = const; the same for both sides.

    They lie evenly along the line. Where cells are short along the chord they are short along the
    span too, so that no cell is more than `aspect` times longer than wide.
    """
    u = np.linspace(0.0, 1.0, max(8 * len(surface.span), 65))
    length = np.zeros((len(u), len(t)))
    step, bend = np.zeros(len(t)), np.zeros(len(t))
    for side in SIDES:
        X = surface(side, u, t)
        away = np.linalg.norm(np.diff(X, axis=0), axis=2)
        length[1:] = np.maximum(length[1:], np.cumsum(away, axis=0))
        step = np.maximum(step, _neighbours(X))
        normal = np.einsum("utx,utx->ut", surface(side, u, t, 2, 0), normals(surface, side, u, t))
        bend = np.maximum(bend, np.abs(normal).max(axis=0))
    h = np.minimum(sizing.size, sizing.aspect * step)
    by_bend = np.sqrt(bend / (8.0 * (1.0 - ALONG_T) * sizing.chord_error))
    number = np.ceil(np.maximum(length[-1] / h, by_bend))
    if not number.sum() <= MOST:
        raise GeometryError(
            f"{number.sum():.2g} points of a side are asked, {MOST:,} at most; ask for larger sizes"
        )
    count = number.astype(int)
    return [even(s, u, max(int(n), 2)) for s, n in zip(length.T, np.maximum(count, 2), strict=True)]


def least_rows(surface: BladeSurface, sizing: Sizing) -> float:
    """Fewer cells than any line t = const has from hub to tip."""
    ends = [surface(side, np.array([0.0, 1.0]), graded(9)) for side in SIDES]
    height = min(float(np.linalg.norm(X[1] - X[0], axis=1).min()) for X in ends)
    return height / sizing.size


def _neighbours(X: Array) -> Vector:
    """Mean distance, over the span, of every line t = const from the nearer of its neighbours."""
    gap = np.linalg.norm(np.diff(X, axis=1), axis=2).mean(axis=0)
    return np.asarray(np.minimum(np.append(gap, np.inf), np.insert(gap, 0, np.inf)))


def even(length: Vector, u: Vector, count: int) -> Vector:
    """u, from 0 to 1, at equal steps of a length that is known at some u."""
    places = np.interp(np.linspace(0.0, length[-1], count + 1), length, u)
    places[[0, -1]] = 0.0, 1.0
    return places


def largest_growth(places: Vector) -> float:
    """Largest ratio of neighbouring steps, either way."""
    steps = np.diff(places)
    ratio = steps[1:] / steps[:-1]
    return float(np.maximum(ratio, 1.0 / ratio).max())
