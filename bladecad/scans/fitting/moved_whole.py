"""A fit to all points, moved rigidly with them."""

from __future__ import annotations

from dataclasses import replace

from bladecad.arrays import Array
from bladecad.deviation.nearest.feet import Feet
from bladecad.fit.blade import BladeFit
from bladecad.scans.fitting.whole import WholeFit
from bladecad.scans.moved import moved_lines, moved_points, moved_side, moved_surface


def moved_whole(whole: WholeFit, move: Array) -> WholeFit:
    """A fit, its surface, its points and their feet moved together."""
    return replace(
        whole,
        fit=_fit(whole.fit, move),
        surface=moved_surface(whole.surface, move),
        points=moved_points(whole.points, move),
        feet=_feet(whole.feet, move),
    )


def _fit(fit: BladeFit, move: Array) -> BladeFit:
    suction, pressure = (moved_side(side, move) for side in (fit.suction, fit.pressure))
    return replace(fit, suction=suction, pressure=pressure, lines=moved_lines(fit.lines, move))


def _feet(feet: Feet, move: Array) -> Feet:
    normal = feet.normal @ move[:3, :3].T
    return replace(feet, foot=moved_points(feet.foot, move), normal=normal)
