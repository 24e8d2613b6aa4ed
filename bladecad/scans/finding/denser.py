"""Coarse meshes, such as CAD programs write: places on their triangles tell the shape."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from bladecad.data.scan import Scan
from bladecad.scans.finding.airfoil import Airfoil
from bladecad.scans.finding.evenly import skin

FEW: Final = 10_000  # vertices on the airfoil that a surface is well laid through
PLACES: Final = 60_000  # spread over its triangles where there are fewer


def is_coarse(airfoil: Airfoil) -> bool:
    """Whether a scan is a mesh with so few vertices that its triangles must tell the shape."""
    return airfoil.scan.triangles is not None and len(airfoil.points) < FEW


def denser(airfoil: Airfoil) -> Scan:
    """Return the vertices of a scan, and after them places on the triangles of its airfoil.

    The places are spread evenly, on triangles, not where anything was measured; a note says so.
    """
    scan = airfoil.scan
    every = np.ones(len(scan.points), bool)
    places = skin(scan, PLACES, every, airfoil.taken)
    said = (
        f"only {airfoil.taken.sum()} of the vertices are on the airfoil; {len(places)} places on "
        "its triangles were taken besides, and the blade is no rounder than they are"
    )
    source = replace(scan.source, notes=(*scan.source.notes, said))
    return Scan(np.concatenate([scan.points, places]), None, source)
