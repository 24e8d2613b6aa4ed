"""Sections of a finished blade, cut from S itself: by what, where and how many."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, TypeAlias, final

import numpy as np

from bladecad.arrays import Vector
from bladecad.data.sections import Axis, Machine, Sections, Source
from bladecad.errors import ToleranceError
from bladecad.pipeline.blade_file import BladeFile
from bladecad.surface.blade import BladeSurface
from bladecad.surface.cut import Cut
from bladecad.surface.cuts import On, cuts, evenly
from bladecad.surface.levels import Cylinders, Level, Planes
from bladecad.surface.loft import SIDES

NEAR: Final = np.radians(20.0)  # stacking axis to the coordinate axis that is taken for it
ON: Final = 1e-6  # of the span: on hub or tip

Direction: TypeAlias = Axis | tuple[float, float, float]


@final
@dataclass(frozen=True)
class CutSettings:
    """Which sections are cut.

    CutSettings()                              the sections of the input, 240 points each
    CutSettings(stations=11)                   eleven stream surfaces, evenly from hub to tip
    CutSettings(stations=(0.1, 0.5, 0.9))      these
    CutSettings(on="planes", stations=(190.0, 240.0))   planes at these heights, mm

    on        : planes square to the stacking axis, cylinders about the machine axis, or streams,
                u = const
    stations  : how many, or the places: heights or radii, mm; u on streams
    points    : of a section, all round
    span_axis : direction that planes are square to; else found
    """

    on: On = "streams"
    stations: int | tuple[float, ...] | None = None
    points: int = 240
    span_axis: Direction | None = None

    def __post_init__(self) -> None:
        if self.span_axis is not None and self.on != "planes":
            raise ToleranceError("a span axis is for planes; leave it out, or cut on planes")


@final
@dataclass(frozen=True, eq=False)
class CutBlade:
    """Sections cut from a surface.

    sections : Sections, hub first, each from the leading edge along the suction side
    cuts     : the same with span, normals and errors
    on       : what they were cut by
    """

    sections: Sections
    cuts: tuple[Cut, ...]
    on: On

    @property
    def error(self) -> float:
        """Largest distance of the points from their planes or cylinders, mm."""
        return max(cut.error for cut in self.cuts)

    @property
    def between(self) -> float:
        """Largest distance of the splines through the points from the blade, mm."""
        return max(cut.between for cut in self.cuts)


def sections_of(blade: BladeFile, settings: CutSettings = CutSettings()) -> CutBlade:
    """Cut a blade into sections.

    Raises
    ------
    ToleranceError
        If stations or points are too few, or make no sense.
    GeometryError
        If a plane, cylinder or stream surface misses the blade.
    """
    surface = blade.surface
    level, notes = _level(surface, blade.machine, settings)
    asked, names = settings.stations, None
    if asked is None and level is None:
        places, names = surface.span, _names(blade)
    elif asked is None or isinstance(asked, int):
        places = evenly(surface, level, len(surface.span) if asked is None else asked)
    else:
        places = _at_least_two(asked)
    found = cuts(surface, level, places.tolist(), points=settings.points, names=names)
    notes += _beyond(found)
    what = f"{settings.on} through {blade.name}"
    source = Source(None, what, axis=blade.machine.axis, axis_from="file", unit_from="file")
    sections = Sections(tuple(cut.section for cut in found), source, blade.machine.row)
    return CutBlade(sections.noted(*blade.notes, *notes), found, settings.on)


def _level(
    surface: BladeSurface, machine: Machine, settings: CutSettings
) -> tuple[Level | None, tuple[str, ...]]:
    if settings.on == "streams":
        return None, ()
    if settings.on == "cylinders":
        return Cylinders(machine.column), ()
    asked = settings.span_axis
    if asked is not None:
        d = np.eye(3)["xyz".index(asked)] if isinstance(asked, str) else np.array(asked)
        return Planes(d), ()
    d = stacking(surface)
    said = "xyz"[int(d.argmax())] if d.max() == 1.0 else ",".join(f"{x:.4g}" for x in d)
    return Planes(d), (f"planes are square to {said}, the stacking axis; --span-axis to choose",)


def stacking(surface: BladeSurface) -> Vector:
    """Direction of the stacking axis, (3,): the line from the middle of the hub to that of the tip.

    The coordinate axis within 20 degrees of it, if there is one: blades are drawn so.
    """
    u, t = np.array([0.0, 1.0]), np.linspace(0.0, 1.0, 101)
    hub, tip = np.mean([surface(side, u, t).mean(axis=1) for side in SIDES], axis=0)
    d = (tip - hub) / np.linalg.norm(tip - hub)
    k = int(np.abs(d).argmax())
    return np.eye(3)[k] if abs(d[k]) >= np.cos(NEAR) else np.asarray(d)


def _names(blade: BladeFile) -> Sequence[str] | None:
    """Names of the sections of the input, where it has them."""
    read = blade.sections.sections if blade.sections else ()
    return [section.name for section in read] if len(read) == len(blade.surface.span) else None


def _at_least_two(places: tuple[float, ...]) -> Vector:
    if len(places) < 2:
        raise ToleranceError(f"{len(places)} station; a file of sections needs 2 at least")
    return np.array(places)


def _beyond(found: Sequence[Cut]) -> tuple[str, ...]:
    """A note on the sections that leave the blade."""
    far = max(max(-cut.u.min(), cut.u.max() - 1.0) for cut in found)
    count = sum(1 for cut in found if cut.u.min() < -ON or cut.u.max() > 1 + ON)
    if not count:
        return ()
    how = f"up to {100 * far:.2g} % of the span beyond hub or tip"
    return (f"{count} sections reach {how}, where the surface is continued as it ends",)
