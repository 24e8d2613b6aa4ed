"""Sections whose edges and sides are named, as some formats need them."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from bladecad.arrays import Points
from bladecad.curves.outline import Track
from bladecad.curves.sides import BladeLines
from bladecad.data.loops import two_sides
from bladecad.data.sections import Sections

NEAR: Final = 0.2  # of the usual step: nearer to an edge point, a point is left out for it


def named(sections: Sections, lines: BladeLines) -> Sections:
    """Return sections that run from the leading edge along the suction side and back.

    The edges become points of the loops; the lines themselves stay what they were.
    """
    sides = zip(lines.names, lines.suction, lines.pressure, strict=True)
    found = tuple(two_sides(name, _points(s), _points(p), suction="first") for name, s, p in sides)
    return replace(sections.noted(*lines.notes), sections=found)


def _points(track: Track) -> Points:
    """Points of a side, from edge to edge."""
    f = track.fractions()
    near = NEAR * float(np.median(np.diff(f)))
    inner = f[(f > near) & (f < 1.0 - near)]
    return track(np.concatenate([[0.0], inner, [1.0]]))
