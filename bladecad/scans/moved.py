"""What is known of a blade, moved rigidly: points, sections, lines, flows."""

from __future__ import annotations

from dataclasses import replace
from typing import Protocol, cast

import numpy as np

from bladecad.arrays import Array, Points, Vector
from bladecad.curves.line import Line
from bladecad.curves.outline import Outline, Track
from bladecad.curves.sides import BladeLines
from bladecad.data.sections import Axis, Sections
from bladecad.fit.sidefit import SideFit
from bladecad.surface.blade import BladeSurface


class WithOne(Protocol):
    """A basis that holds the constant 1."""

    @property
    def one(self) -> Vector:
        """Its coefficients."""


def moved_points(points: Points, move: Array) -> Points:
    """Points moved by a (4, 4) rigid motion."""
    return np.asarray(points @ move[:3, :3].T + move[:3, 3])


def moved_sections(sections: Sections, move: Array, axis: Axis) -> Sections:
    """Sections moved; `axis` is the machine axis then."""
    found = tuple(replace(s, points=moved_points(s.points, move)) for s in sections.sections)
    source = replace(sections.source, axis=axis, axis_from="default")
    return replace(sections, sections=found, source=source)


def moved_surface(surface: BladeSurface, move: Array) -> BladeSurface:
    """A surface moved: its flows share the constant 1, which carries the shift."""
    suction, pressure = (moved_side(side, move) for side in (surface.suction, surface.pressure))
    return replace(surface, suction=suction, pressure=pressure)


def moved_side(side: SideFit, move: Array) -> SideFit:
    """The flows of a side moved."""
    ones = np.array([cast(WithOne, basis).one for basis in side.bases])
    turned = side.coefficients @ move[:3, :3].T
    return replace(side, coefficients=turned + ones[:, :, None] * move[:3, 3])


def moved_lines(lines: BladeLines, move: Array) -> BladeLines:
    """Lines, and what they were found from, moved."""
    suction, pressure = (
        tuple(_track(track, move) for track in side) for side in (lines.suction, lines.pressure)
    )
    outlines = tuple(_outline(outline, move) for outline in lines.outlines)
    return replace(lines, suction=suction, pressure=pressure, outlines=outlines)


def _outline(outline: Outline, move: Array) -> Outline:
    """The outline itself moved; laid flat it stays as it is."""
    section = replace(outline.section, points=moved_points(outline.section.points, move))
    first, second = (_track(track, move) for track in outline.sides)
    return replace(outline, section=section, sides=(first, second))


def _track(track: Track, move: Array) -> Track:
    return replace(track, line=Line(moved_points(track.line.points, move), track.line.closed))
