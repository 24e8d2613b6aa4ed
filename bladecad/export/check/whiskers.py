"""A section with its deviations drawn as whiskers: flat, and magnified so that one sees them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal, final

import numpy as np

from bladecad.arrays import Array, Mask, Vector
from bladecad.deviation.inspecting.inspection import Inspection
from bladecad.deviation.sectioning.section_result import SectionResult
from bladecad.export.check.zones import bounds_at

REACH: Final = 0.08  # of what is shown, the longest whisker at most
EDGE: Final = 0.08  # of the chord, that a close view of an edge shows
Part = Literal["section", "leading edge", "trailing edge"]
PARTS: Final[tuple[Part, ...]] = ("section", "leading edge", "trailing edge")


@final
@dataclass(frozen=True, eq=False)
class Whiskers:
    """A section laid flat: from the leading edge along the chord, suction side up, mm.

    name, u   : of the section
    line      : (n, 2) float, the nominal outline as a loop
    normal    : (n, 2) float, unit normals
    t         : (n,) float, chordwise place
    suction   : (n,) bool
    deviation : (n,) float, mm, NaN where not measured
    bounds    : (n, 2) float, mm, of the band there
    """

    name: str
    u: float
    line: Array
    normal: Array
    t: Vector
    suction: Mask
    deviation: Vector
    bounds: Array

    @property
    def chord(self) -> float:
        """Extent along the chord, mm."""
        return float(np.ptp(self.line[:, 0]))

    @property
    def excess(self) -> Vector:
        """How far outside its band each place is, negative inside, (n,) mm."""
        d = self.deviation
        return np.asarray(np.maximum(d - self.bounds[:, 1], self.bounds[:, 0] - d))

    @property
    def rank(self) -> Vector:
        """What makes a place worse than another: its excess, its size where it has no band."""
        return np.where(np.isfinite(self.excess), self.excess, np.abs(self.deviation))

    @property
    def worst(self) -> int | None:
        """Number of the place furthest out of its band, or nearest to leaving it."""
        known = np.isfinite(self.deviation)
        return int(np.where(known, self.rank, -np.inf).argmax()) if known.any() else None

    def moved(self, distance: Vector, magnification: float) -> Array:
        """The outline moved along its normals, (n, 2)."""
        return np.asarray(self.line + magnification * distance[:, None] * self.normal)

    def within(self, part: Part, *, wider: float = 1.0) -> Mask:
        """Which places a view of a part shows, or one so many times wider, (n,)."""
        x, wide = self.line[:, 0] - self.line[:, 0].min(), wider * EDGE * self.chord
        if part == "section":
            return np.ones(len(x), bool)
        return np.asarray(x <= wide if part == "leading edge" else x >= self.chord - wide)

    def magnification(self, part: Part = "section") -> float:
        """How many times larger than the section its deviations are drawn: a round number."""
        shown = self.within(part)
        extent = float(np.ptp(self.line[shown], axis=0).max())
        sizes = np.abs(np.column_stack([self.deviation, self.bounds])[shown])
        largest = float(np.nanmax(sizes, initial=0.0))
        return round_down(REACH * extent / largest) if largest * extent > 0.0 else 1.0


def thinned(whiskers: Whiskers, most: int) -> Whiskers:
    """Keep at most so many places, of every run of neighbours the one that is worst."""
    n = len(whiskers.t)
    if n <= most:
        return whiskers
    first = np.unique(np.linspace(0, n, most, endpoint=False).astype(int))
    rank = np.where(np.isfinite(whiskers.deviation), whiskers.rank, -np.inf)
    runs = np.split(np.arange(n), first[1:])
    kept = np.array([run[rank[run].argmax()] for run in runs])
    w = whiskers
    return Whiskers(w.name, w.u, w.line[kept], w.normal[kept], w.t[kept], w.suction[kept],
                    w.deviation[kept], w.bounds[kept])  # fmt: skip


def whiskers(inspection: Inspection, section: SectionResult) -> Whiskers:
    """Lay a section of an inspection flat, with the bands of the zones that it runs through."""
    u = np.full(len(section.t), section.u)
    bounds = bounds_at(inspection.tolerances, section.suction, u, section.t)
    return Whiskers(section.name, section.u, section.flat, section.flat_normal, section.t,
                    section.suction, section.deviation, bounds)  # fmt: skip


def round_down(x: float) -> float:
    """Return the next lower of 1, 2, 5 times a power of ten."""
    ten = 10.0 ** np.floor(np.log10(x))
    steps = np.array([1.0, 2.0, 5.0])
    return float(f"{steps[steps * ten <= x * (1.0 + 1e-9)][-1] * ten:.6g}")
