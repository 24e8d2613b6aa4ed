"""What is followed: both sides of a blade, whole or the smooth core alone, as points and lines."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Final, Literal, final

import numpy as np

from bladecad.arrays import Lines, Vector, seal
from bladecad.curves.outline import EdgeKind
from bladecad.curves.sides import BladeLines, Side
from bladecad.fit.samples import Samples, shared_parameters

Region = Literal["core", "full"]
REGIONS: Final[tuple[Region, Region]] = ("core", "full")
CORE: Final = (0.03, 0.97)  # of a side: what is left when the rounded edges are cut away
SIDE_NAMES: Final[tuple[Side, Side]] = ("suction", "pressure")
FITTED, JUDGED = 4, 9  # samples a gap: what is fitted is not what is judged


@final
@dataclass(frozen=True, eq=False)
class Stretch:
    """One side of every section, from edge to edge or its core.

    lines       : the measured blade
    side        : suction or pressure
    first, last : where the stretch begins and ends on the side
    t           : (k,) float; parameters of the points, 0 to 1 on the stretch, the same on all
                  sections, as dense as the measured points
    shift       : (3,) float, mm; where the blade has been moved
    """

    lines: BladeLines
    side: Side
    first: float
    last: float
    t: Vector
    shift: Vector = field(default_factory=lambda: np.zeros(3))

    def __post_init__(self) -> None:
        seal(self, t=(None,), shift=(3,))

    def __call__(self, t: Vector) -> Lines:
        """Points of every densified section, (m, len(t), 3), mm."""
        return self.lines.sample(self.side, self.first + (self.last - self.first) * t) + self.shift

    @cached_property
    def points(self) -> Lines:
        """The points, (m, k, 3), mm."""
        return self(self.t)

    @cached_property
    def fitted(self) -> Samples:
        """What fits to the line itself are made to."""
        return self._between(FITTED)

    @cached_property
    def judged(self) -> Samples:
        """What all fits are judged on."""
        return self._between(JUDGED)

    def _between(self, per_gap: int) -> Samples:
        places = np.arange((len(self.t) - 1) * per_gap + 1) / per_gap
        t = np.interp(places, np.arange(len(self.t)), self.t)
        return Samples(t, self(t))


@final
@dataclass(frozen=True, eq=False)
class Subject:
    """One blade, or its core, as a model meets it.

    le, te : kind of the edges; those of a core are cut off
    """

    name: str
    region: Region
    suction: Stretch
    pressure: Stretch
    le: EdgeKind
    te: EdgeKind

    @property
    def sides(self) -> tuple[Stretch, Stretch]:
        """Suction side, pressure side."""
        return self.suction, self.pressure

    def moved(self, shift: Vector) -> Subject:
        """Return the same blade somewhere else."""
        suction, pressure = (replace(s, shift=s.shift + shift) for s in self.sides)
        return replace(self, suction=suction, pressure=pressure)


def subject(name: str, lines: BladeLines, region: Region, count: int | None = None) -> Subject:
    """Take both sides of a blade, `count` points each, or as many as were measured."""
    first, last = CORE if region == "core" else (0.0, 1.0)
    suction = stretch(lines, "suction", first, last, count)
    pressure = stretch(lines, "pressure", first, last, count)
    if region == "core":
        return Subject(name, region, suction, pressure, "blunt", "blunt")
    return Subject(name, region, suction, pressure, lines.le, lines.te)


def stretch(lines: BladeLines, side: Side, first: float, last: float, count: int | None) -> Stretch:
    """Take the points of a stretch where the measured points lie: their quantiles."""
    places = shared_parameters(lines.parameters(side), FITTED)
    number = np.arange(len(places))
    begin, end = np.interp([first, last], places, number)
    k = count or max(round((end - begin) / FITTED) + 1, 16)
    t = np.interp(np.linspace(begin, end, k), number, places)
    return Stretch(lines, side, first, last, (t - first) / (last - first))
