"""The paper's layout: 15 sections of 71 points a side on a blade 100 mm long."""

from __future__ import annotations

from typing import Final

import numpy as np

from bladecad.arrays import Array, Lines
from bladecad.curves.sides import BladeLines
from bladecad.data.sections import Section, Sections, Source
from bladecad.replay.subject import stretch
from bladecad.splines import basis, not_a_knot

SECTIONS: Final = 15
POINTS: Final = 71
LENGTH: Final = 100.0  # mm, hub to tip


def paper_layout(lines: BladeLines) -> Sections:
    """Lay a measured blade out as the paper's: same shape, its sections, points and size.

    Every side is taken at 71 parameters, as dense at the edges as the measured points are. Along
    the span the C2 spline through the measured sections gives 15 at equal distances. All is scaled
    about the origin of the file, on the machine axis, until hub and tip are 100 mm apart.
    """
    sides = [stretch(lines, side, 0.0, 1.0, POINTS).points for side in ("suction", "pressure")]
    suction, pressure = (_along_span(lines, side) for side in sides)
    size = LENGTH / blade_length(np.concatenate([suction, pressure], axis=1))
    loops = size * np.concatenate([suction, pressure[:, -2:0:-1]], axis=1)
    sections = tuple(
        Section(f"{i + 1}", loop, le=(0,), te=(POINTS - 1,), suction="first")
        for i, loop in enumerate(loops)
    )
    return Sections(sections, Source(None, "the paper's layout"))


def blade_length(points: Lines) -> float:
    """Mean distance from hub to tip through all sections, mm."""
    steps = np.linalg.norm(np.diff(points, axis=0), axis=2)
    return float(steps.sum(axis=0).mean())


def _along_span(lines: BladeLines, points: Lines) -> Array:
    knots, degree = not_a_knot(lines.span)
    to_poles = np.linalg.inv(basis(knots, degree, lines.span))
    N = basis(knots, degree, np.linspace(0.0, 1.0, SECTIONS))
    return np.asarray(np.einsum("ui,ikx->ukx", N @ to_poles, points))
