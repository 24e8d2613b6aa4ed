"""How the sides are divided into patches: two sides, four zones, or one patch all the way round."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from typing import Literal, TypeAlias, final

from bladecad.arrays import Array
from bladecad.errors import GeometryError
from bladecad.surface.blade import EdgeKind, SideName
from bladecad.surface.cutting import cut, joined, matched, turned_round
from bladecad.surface.patch import SplinePatch
from bladecad.surface.zone_ends import border, edge_kind

Faces: TypeAlias = Literal[1, 2, 4]
Part: TypeAlias = Literal["suction", "pressure", "leading", "trailing", "round"]


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
    a, b = (border(suction, pressure, k) if kinds[k] == "round" else float(-k) for k in (0, -1))
    if not a < b:
        raise GeometryError(
            f"patches of {suction.poles.shape[1]} poles along t are too coarse for zones of their "
            "edges; ask for --faces 2"
        )
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
        back, ahead, moved["leading"] = matched(turned_round(suction), pressure, allowed=allowed)
        suction, pressure = _with(suction, back.poles[:, ::-1]), _with(pressure, ahead.poles)
    if kinds[1] == "round":
        ahead, back, moved["trailing"] = matched(suction, turned_round(pressure), allowed=allowed)
        suction, pressure = _with(suction, ahead.poles), _with(pressure, back.poles[:, ::-1])
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


def _with(patch: SplinePatch, poles: Array) -> SplinePatch:
    """The same knots, to the last bit: turned round twice, 1 - (1 - t) is not t."""
    return SplinePatch(poles, patch.knots_u, patch.knots_t, patch.degree_u, patch.degree_t)
