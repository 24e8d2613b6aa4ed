"""What was measured: sections, each a loop of points round the airfoil, and their source."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal, final

import numpy as np

from bladecad.arrays import Points, Vector, seal
from bladecad.errors import DataError

Axis = Literal["x", "y", "z"]
Unit = Literal["mm", "cm", "m", "in", "ft"]
Origin = Literal["file", "option", "default"]
Arc = Literal["first", "second"]

MM_PER: dict[Unit, float] = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4, "ft": 304.8}


@final
@dataclass(frozen=True, eq=False)
class Section:
    """One section: a loop of points round the airfoil, in order, in either direction.

    name    : as the file calls it
    points  : (n, 3) float, mm; the first point is not repeated at the end
    closed  : False where the file leaves the loop open between its last point and its first
    le, te  : indices into `points` where the file says which points are the edge:
              () not said, (i,) a round edge, (i, j) the two corners of a blunt, cut-off edge.
              With j the later corner in loop order: the edge face runs from points[i] to points[j]
    suction : where the file says which side is which: "first" if the arc that runs in loop order
              from the leading to the trailing edge is the suction side, "second" if it is the
              pressure side
    """

    name: str
    points: Points
    closed: bool = True
    le: tuple[int, ...] = ()
    te: tuple[int, ...] = ()
    suction: Arc | None = None

    def __post_init__(self) -> None:
        seal(self, points=(None, 3))
        n = len(self.points)
        for edge, corners in (("leading", self.le), ("trailing", self.te)):
            if len(corners) > 2 or any(not 0 <= i < n for i in corners):
                raise DataError(
                    f'section "{self.name}": {edge} edge at points {corners}, '
                    f"the loop has {n} points"
                )


@final
@dataclass(frozen=True, eq=False)
class Row:
    """The blade row round the blade, as far as the file tells.

    blade_count : blades in the row, None if not said
    hub, shroud : (n, 2) float, mm; axial position and radius, inlet to outlet; empty if not said
    """

    blade_count: int | None = None
    hub: Vector = field(default_factory=lambda: np.empty((0, 2)))
    shroud: Vector = field(default_factory=lambda: np.empty((0, 2)))

    def __post_init__(self) -> None:
        seal(self, hub=(None, 2), shroud=(None, 2))


@final
@dataclass(frozen=True, eq=False)
class Machine:
    """The machine round a blade: its axis, through the origin, and the row."""

    axis: Axis = "z"
    row: Row = field(default_factory=Row)

    @property
    def column(self) -> int:
        """Of the axis: 0, 1 or 2."""
        return "xyz".index(self.axis)


@final
@dataclass(frozen=True)
class Source:
    """Where the sections came from, and what had to be guessed.

    notes : sentences for the user: what was guessed, repaired or dropped, and how to say otherwise
    """

    path: Path | None
    format: str
    unit: Unit = "mm"
    unit_from: Origin = "default"
    axis: Axis = "z"
    axis_from: Origin = "default"
    notes: tuple[str, ...] = ()


@final
@dataclass(frozen=True, eq=False)
class Sections:
    """A blade as its sections, in the order of the file, in mm, in the frame of the file."""

    sections: tuple[Section, ...]
    source: Source
    row: Row = field(default_factory=Row)

    @property
    def axis(self) -> int:
        """Column of the machine axis: 0, 1 or 2."""
        return "xyz".index(self.source.axis)

    @property
    def machine(self) -> Machine:
        """Axis and row."""
        return Machine(self.source.axis, self.row)

    def noted(self, *notes: str) -> Sections:
        """Return the same blade with further notes for the user."""
        return replace(self, source=replace(self.source, notes=self.source.notes + notes))
