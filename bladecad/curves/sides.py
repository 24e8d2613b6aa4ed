"""Sections become the two sides of a blade: which edge leads, which side is suction, which span."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, final

import numpy as np

from bladecad.arrays import Lines, Mask, Vector, seal
from bladecad.curves.naming import Hand, Lead, first_is_left, leading_edge, suction_side
from bladecad.curves.outline import EdgeKind, Outline, Track, trace
from bladecad.data.sections import Sections
from bladecad.errors import DataError

Edges = Literal["file", "find"]
Side = Literal["suction", "pressure"]
PROBES = np.linspace(0.0, 1.0, 33)


@final
@dataclass(frozen=True, eq=False)
class BladeLines:
    """Both sides of every section, hub first, each from the leading to the trailing edge.

    names      : of the sections
    suction, pressure : one track a section
    span       : (m,) float, u of the sections, rising from the hub, 0, to the tip, 1
    le, te     : kind of the edges, the same on all sections
    outlines   : the sections as they were broken, in the same order
    notes      : what was guessed or repaired, and how to say otherwise
    """

    names: tuple[str, ...]
    suction: tuple[Track, ...]
    pressure: tuple[Track, ...]
    span: Vector
    le: EdgeKind
    te: EdgeKind
    outlines: tuple[Outline, ...]
    notes: tuple[str, ...]

    def __post_init__(self) -> None:
        seal(self, span=(len(self.names),))

    @property
    def sides(self) -> dict[Side, tuple[Track, ...]]:
        """The tracks by the name of the side."""
        return {"suction": self.suction, "pressure": self.pressure}

    @property
    def lengths(self) -> Vector:
        """(m,) float: mean arc length of the two sides, mm; dt/ds at the edges is its inverse."""
        pairs = zip(self.suction, self.pressure, strict=True)
        return np.array([0.5 * (s.length + p.length) for s, p in pairs])

    def sample(self, side: Side, t: Vector) -> Lines:
        """Points of every section at the same parameters t, (m, k, 3), mm."""
        pairs = zip(self.sides[side], self.lengths, strict=True)
        return np.array([track(fraction_of(t, track.length / L)) for track, L in pairs])

    def parameters(self, side: Side) -> list[Vector]:
        """Parameter t of the measured points of each section."""
        pairs = zip(self.sides[side], self.lengths, strict=True)
        return [parameter_of(track.fractions(), track.length / L) for track, L in pairs]


def parameter_of(fraction: Vector, ratio: float) -> Vector:
    """Parameter t at a fraction of the arc length, t = s/L + (L/Lm - 1) b(s/L).

    The odd quintic b has b = 0, b' = 1, b'' = 0 at both ends, so that dt/ds = 1/Lm there on both
    sides; `ratio` is L/Lm.
    """
    x = 2.0 * fraction - 1.0
    return np.asarray(fraction + (ratio - 1.0) * x * (-7.0 + x**2 * (10.0 - 3.0 * x**2)) / 16.0)


def fraction_of(t: Vector, ratio: float) -> Vector:
    """Fraction of the arc length at parameter t, the inverse of `parameter_of`."""
    f = np.array(t, dtype=np.float64)
    for _ in range(8):
        x2 = (2.0 * f - 1.0) ** 2
        slope = 1.0 + (ratio - 1.0) * (-7.0 + x2 * (30.0 - 15.0 * x2)) / 8.0
        f = np.clip(f - (parameter_of(f, ratio) - t) / slope, 0.0, 1.0)
    return f


def split_sides(
    sections: Sections,
    *,
    le: Lead | None = None,
    suction: Hand | None = None,
    edges: Edges = "file",
    keep: Sequence[Mask] | None = None,
) -> BladeLines:
    """Break every section at its edges and name edges and sides, the whole blade at once.

    Parameters
    ----------
    sections : Sections
        Hub to tip.
    le : {"low", "high"}, optional
        The edge with the lower or the higher coordinate along the machine axis (outwards on a
        radial machine) leads. Otherwise: what the file says, the direction of the hub line, the
        shape, the lower coordinate, in that order.
    suction : {"left", "right"}, optional
        Side seen from the leading edge along the chord, from outside the machine. Otherwise: what
        the file says on most sections, else the side towards which the camber line bulges.
    edges : {"file", "find"}
        "find" looks for round edges by shape even where the file names a point.
    keep : one (n,) bool a section, optional
        Points to use.

    Raises
    ------
    DataError
        If a section has no two edges, or the edges differ in kind along the span.
    """
    outlines = _outlines(sections, edges == "find", keep)
    led, why_lead = leading_edge(outlines, sections, le)
    outlines = [o.turned() for o in outlines] if led == "high" else outlines
    left, why_suction = suction_side(outlines, suction)
    hands = [o.sides if first_is_left(o) == left else o.sides[::-1] for o in outlines]
    on_suction, on_pressure = zip(*hands, strict=True)
    return BladeLines(
        tuple(s.name for s in sections.sections),
        on_suction,
        on_pressure,
        _span(on_suction, on_pressure),
        outlines[0].kinds[0],
        outlines[0].kinds[1],
        tuple(outlines),
        (*why_lead, *why_suction),
    )


def _outlines(sections: Sections, find: bool, keep: Sequence[Mask] | None) -> list[Outline]:
    """Trace all sections; where their edges differ in kind, take the edges as round."""
    masks = keep or [np.ones(len(s.points), bool) for s in sections.sections]
    pairs = list(zip(sections.sections, masks, strict=True))
    outlines = [_facing(trace(s, sections.axis, keep=k, find=find)) for s, k in pairs]
    if len({o.kinds for o in outlines}) > 1:
        outlines = [
            _facing(trace(s, sections.axis, keep=k, find=find, smooth=True)) for s, k in pairs
        ]
    for o in outlines:
        if o.kinds != outlines[0].kinds:
            raise DataError(
                f'section "{o.section.name}": edges are {" and ".join(o.kinds)}, on section '
                f'"{outlines[0].section.name}" {" and ".join(outlines[0].kinds)}; tag the corners '
                "of a cut-off edge on all sections or on none"
            )
    return _alike(outlines)


def _facing(outline: Outline) -> Outline:
    """Put the edge with the lower coordinate along the machine first."""
    first, last = outline.flat.points[[_nearest(outline, f) for f in (0.0, 1.0)]]
    along = 0 if abs(last[0] - first[0]) > 0.05 * np.linalg.norm(last - first) else 1
    return outline.turned() if first[along] > last[along] else outline


def _alike(outlines: list[Outline]) -> list[Outline]:
    """Turn outlines whose edges lie nearer to those of their neighbour the other way round.

    A chord across the machine axis does not tell which edge is the lower; begin where it tells
    most.
    """
    ends = [o.sides[0](np.array([0.0, 1.0])) for o in outlines]
    rise = [_rise(o) for o in outlines]
    first = int(np.argmax(rise))
    order = [(k, k - 1) for k in range(first + 1, len(ends))]
    order += [(k, k + 1) for k in range(first - 1, -1, -1)]
    for k, beside in order:
        straight, across = (np.linalg.norm(e - ends[beside]) for e in (ends[k], ends[k][::-1]))
        if across < straight:
            outlines[k], ends[k] = outlines[k].turned(), ends[k][::-1]
    return outlines


def _rise(outline: Outline) -> float:
    """Rise along the machine axis from edge to edge, over their distance."""
    first, last = outline.flat.points[[_nearest(outline, f) for f in (0.0, 1.0)]]
    return float(abs(last[0] - first[0]) / np.linalg.norm(last - first))


def _nearest(outline: Outline, fraction: float) -> int:
    """Number of the measured point nearest to a place on the first side."""
    place = outline.sides[0](np.array([fraction]))
    return int(np.linalg.norm(outline.section.points - place, axis=1).argmin())


def _span(suction: Sequence[Track], pressure: Sequence[Track]) -> Vector:
    """Accumulated mean distance from section to section, over the whole: 0 at the hub."""
    points = np.array(
        [np.concatenate([s(PROBES), p(PROBES)]) for s, p in zip(suction, pressure, strict=True)]
    )
    steps = np.linalg.norm(np.diff(points, axis=0), axis=2).mean(axis=1)
    run = np.concatenate([[0.0], np.cumsum(steps)])
    return np.asarray(run / run[-1])
