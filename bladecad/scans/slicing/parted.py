"""Sections of a scan put in order and parted at their edges, whatever pose it was scanned in."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from bladecad.arrays import Array
from bladecad.curves.naming import Hand, Lead
from bladecad.curves.repair import repaired
from bladecad.curves.sides import BladeLines, split_sides
from bladecad.data.sections import Sections
from bladecad.scans.finding.airfoil import Airfoil
from bladecad.scans.moved import moved_lines, moved_sections
from bladecad.scans.upright import across, motion, upright


def parted(
    airfoil: Airfoil, sections: Sections, *, le: Lead | None = None, suction: Hand | None = None
) -> tuple[Sections, BladeLines]:
    """Put sections of a scan in order, and name their edges and sides.

    The blade is set up, looked at, and laid back; see `upright`.

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
    move = _move(airfoil)
    back = np.asarray(np.linalg.inv(move), dtype=np.float64)
    stood = repaired(moved_sections(sections, move, "z"), ordered=True)
    lines = split_sides(stood, le=le, suction=suction)
    laid = moved_sections(stood, back, sections.source.axis)
    source = replace(laid.source, axis_from=sections.source.axis_from)
    return replace(laid, source=source), moved_lines(lines, back)


def _move(airfoil: Airfoil) -> Array:
    height = airfoil.height
    if height.kind == "plane":
        return upright(airfoil.axis, airfoil.points)
    return motion(height.axis, across(airfoil.axis, height.axis), height.origin)
