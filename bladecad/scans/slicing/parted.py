"""Sections of a scan put in order and parted at their edges, whatever pose it was scanned in."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from bladecad.arrays import Array, Vector
from bladecad.curves.naming import Hand, Lead
from bladecad.curves.repair import repaired
from bladecad.curves.sides import BladeLines, split_sides
from bladecad.data.sections import Sections
from bladecad.scans.finding.airfoil import Airfoil
from bladecad.scans.moved import moved_lines, moved_sections

ALONG: Final = 0.95  # cosine from which on a direction is no machine axis across the span
AWAY: Final = 20.0  # times the span: as far from the machine axis is the blade set up


def parted(
    airfoil: Airfoil, sections: Sections, *, le: Lead | None = None, suction: Hand | None = None
) -> tuple[Sections, BladeLines]:
    """Put sections of a scan in order, and name their edges and sides.

    The blade is set up with its stacking axis pointing away from a machine axis, looked at, and
    laid back: a scan lies anywhere, and `repaired` and `split_sides` ask where the machine is.

    Parameters
    ----------
    airfoil : Airfoil
    sections : Sections
        In the frame of the scan, from `slice_airfoil`.
    le : {"low", "high"}, optional
        The edge with the lower or the higher coordinate along z of the scan, along x where z is
        the stacking axis, leads; with cylinders or cones, along the machine axis.
    suction : {"left", "right"}, optional

    Returns
    -------
    sections, lines
        In the frame of the scan.

    Raises
    ------
    DataError
        As `repaired` and `split_sides` do.
    """
    move = upright(airfoil)
    back = np.asarray(np.linalg.inv(move), dtype=np.float64)
    stood = repaired(moved_sections(sections, move, "z"))
    lines = split_sides(stood, le=le, suction=suction)
    laid = moved_sections(stood, back, sections.source.axis)
    source = replace(laid.source, axis_from=sections.source.axis_from)
    return replace(laid, source=source), moved_lines(lines, back)


def upright(airfoil: Airfoil) -> Array:
    """The rigid motion, (4, 4), after which z is the machine axis and the blade stands along x."""
    height = airfoil.height
    points = airfoil.points
    if height.kind != "plane":
        return _motion(height.axis, _across(airfoil.axis, height.axis), height.origin)
    z = np.eye(3)[2] if abs(airfoil.axis[2]) < ALONG else np.eye(3)[0]
    away = AWAY * (airfoil.high - airfoil.low)
    return _motion(
        _across(z, airfoil.axis), airfoil.axis, points.mean(axis=0) - away * airfoil.axis
    )


def _motion(z: Vector, x: Vector, origin: Vector) -> Array:
    rows = np.stack([x, np.cross(z, x), z])
    move = np.eye(4)
    move[:3, :3], move[:3, 3] = rows, -rows @ origin
    return move


def _across(v: Vector, axis: Vector) -> Vector:
    """The unit direction of what is left of v across an axis."""
    rest = v - (v @ axis) * axis
    return np.asarray(rest / np.linalg.norm(rest))
