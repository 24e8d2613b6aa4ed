"""How the sides are divided into patches: two sides, four zones, or one patch all the way round."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Final, Literal, TypeAlias, final

import numpy as np

from bladecad.arrays import Array, Vector
from bladecad.errors import GeometryError
from bladecad.surface.blade import EdgeKind, SideName
from bladecad.surface.cutting import cut, joined, matched, turned_round
from bladecad.surface.patch import SplinePatch

Faces: TypeAlias = Literal[1, 2, 4]
Part: TypeAlias = Literal["suction", "pressure", "leading", "trailing", "round"]

CORNER: Final = np.radians(1.0)  # sides that meet at a larger angle are meant to have a corner
ABREAST: Final = np.radians(30.0)  # between the sides where an edge ends and the body begins
WIDEST: Final = 0.15  # an edge, in t


@final
@dataclass(frozen=True, eq=False)
class Stretch:
    """A part of one side, run through from t = `first` to t = `last`, either way."""

    side: SideName
    first: float
    last: float


@final
@dataclass(frozen=True, eq=False)
class Zone:
    """One four-sided patch and what it covers of the sides, one stretch after the other."""

    part: Part
    patch: SplinePatch
    stretches: tuple[Stretch, ...]


@final
@dataclass(frozen=True, eq=False)
class Division:
    """The sides, and the zones that cover them without a gap or an overlap.

    suction, pressure : SplinePatch
        Where a zone runs round an edge, poles beside it moved so that it does so smoothly.
    zones : tuple of Zone
    moved : float
        No point of the sides moved further, mm.
    """

    suction: SplinePatch
    pressure: SplinePatch
    zones: tuple[Zone, ...]
    moved: float


def edge_kind(suction: SplinePatch, pressure: SplinePatch, column: int) -> EdgeKind:
    """Tell a blunt edge, where the sides are apart, from a corner and from a round one.

    column : 0 for the leading edge, -1 for the trailing edge
    """
    if not np.array_equal(suction.poles[:, column], pressure.poles[:, column]):
        return "blunt"
    u, end = _places(suction.knots_u), suction.knots_t[[column]]
    along, back = suction(u, end, 0, 1)[:, 0], -pressure(u, end, 0, 1)[:, 0]
    return "sharp" if _angles(along, back).max() > CORNER else "round"


def divide(
    suction: SplinePatch, pressure: SplinePatch, faces: Faces, *, allowed: float
) -> Division:
    """Divide the sides of a blade into four-sided patches, u along the span, t along the chord.

    Parameters
    ----------
    suction, pressure : SplinePatch
        On the same knots.
    faces : {2, 4, 1}
        2: the sides, as they are. 4: a zone of its own round every round edge, to where the
        sides, opposite at the edge line, run within 30 degrees of each other at every u. 1: one
        patch from the trailing edge round the leading edge and back; where the leading edge is
        blunt or sharp, from there round the trailing edge.
    allowed : float
        mm; poles beside a round edge may be moved so far that a patch runs through it C2, or C1
        where the sides have one tangent and curvature there, but not one X_tt, as offsets have.

    Raises
    ------
    GeometryError
        If sides that meet without a corner do not meet C1 to `allowed`, or if no single patch
        covers both sides.
    """
    kinds = edge_kind(suction, pressure, 0), edge_kind(suction, pressure, -1)
    if faces == 2:
        sides = _whole("suction", suction), _whole("pressure", pressure)
        return Division(suction, pressure, sides, 0.0)
    if faces == 1:
        return _one(suction, pressure, kinds, allowed)
    return _four(suction, pressure, kinds, allowed)


def _one(
    suction: SplinePatch, pressure: SplinePatch, kinds: Sequence[EdgeKind], allowed: float
) -> Division:
    if "round" not in kinds:
        raise GeometryError(
            f"no single face runs round a blade with a {kinds[0]} leading and a {kinds[1]} "
            "trailing edge; ask for --faces 2"
        )
    over = 0 if kinds[0] == "round" else -1
    suction, pressure, moved = _meeting(suction, pressure, kinds, allowed)
    far = 1.0 if over == 0 else 0.0
    stretches = Stretch("suction", far, 1.0 - far), Stretch("pressure", 1.0 - far, far)
    zone = Zone("round", _patch(suction, pressure, stretches), stretches)
    return Division(suction, pressure, (zone,), moved)


def _four(
    suction: SplinePatch, pressure: SplinePatch, kinds: Sequence[EdgeKind], allowed: float
) -> Division:
    suction, pressure, moved = _meeting(suction, pressure, kinds, allowed)
    a, b = (_border(suction, pressure, k) if kinds[k] == "round" else float(-k) for k in (0, -1))
    covered: list[tuple[Part, tuple[Stretch, ...]]] = [
        ("suction", (Stretch("suction", a, b),)),
        ("pressure", (Stretch("pressure", a, b),)),
    ]
    if a > 0.0:
        covered.append(("leading", (Stretch("suction", a, 0.0), Stretch("pressure", 0.0, a))))
    if b < 1.0:
        covered.append(("trailing", (Stretch("suction", b, 1.0), Stretch("pressure", 1.0, b))))
    zones = tuple(Zone(part, _patch(suction, pressure, s), s) for part, s in covered)
    return Division(suction, pressure, zones, moved)


def _whole(name: SideName, patch: SplinePatch) -> Zone:
    return Zone(name, patch, (Stretch(name, 0.0, 1.0),))


def _meeting(
    suction: SplinePatch, pressure: SplinePatch, kinds: Sequence[EdgeKind], allowed: float
) -> tuple[SplinePatch, SplinePatch, float]:
    """Make the sides meet smoothly at their round edges; tell how far that moved them."""
    moved = {"leading": 0.0, "trailing": 0.0}
    if kinds[0] == "round":
        back, pressure, moved["leading"] = matched(turned_round(suction), pressure, allowed=allowed)
        suction = turned_round(back)
    if kinds[1] == "round":
        suction, back, moved["trailing"] = matched(suction, turned_round(pressure), allowed=allowed)
        pressure = turned_round(back)
    edge = max(moved, key=lambda name: moved[name])
    if moved[edge] > allowed:
        raise GeometryError(
            f"the sides meet at the {edge} edge, but not C1: a face through it is off by "
            f"{moved[edge]:.3g} mm, {allowed:g} mm are allowed; ask for --faces 2"
        )
    return suction, pressure, moved[edge]


def _patch(
    suction: SplinePatch, pressure: SplinePatch, stretches: Sequence[Stretch]
) -> SplinePatch:
    sides = {"suction": suction, "pressure": pressure}
    return reduce(joined, (_part(sides[s.side], s) for s in stretches))


def _part(side: SplinePatch, stretch: Stretch) -> SplinePatch:
    low, high = sorted((stretch.first, stretch.last))
    part = cut(side, low, high)
    return part if stretch.first < stretch.last else turned_round(part)


def _border(suction: SplinePatch, pressure: SplinePatch, column: int) -> float:
    """The first knot, from the edge, at which the sides run abreast at every u."""
    u, knots = _places(suction.knots_u), np.unique(suction.knots_t)
    t = knots if column == 0 else knots[::-1]
    between = _angles(suction(u, t, 0, 1), pressure(u, t, 0, 1)).max(axis=0)
    enough = (between <= ABREAST) | (np.abs(t - t[0]) > WIDEST)
    enough[:2] = False  # a zone has room for two knots at least
    return float(t[np.argmax(enough)])


def _angles(a: Array, b: Array) -> Vector:
    """Angles between vectors in the last axis, radians."""
    sine = np.linalg.norm(np.cross(a, b), axis=-1)
    return np.asarray(np.arctan2(sine, np.einsum("...x,...x->...", a, b)))


def _places(knots: Vector) -> Vector:
    breaks = np.unique(knots)
    return np.union1d(breaks, 0.5 * (breaks[1:] + breaks[:-1]))
