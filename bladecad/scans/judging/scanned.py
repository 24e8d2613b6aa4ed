"""What is known of a blade besides, where it came from a scan."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from bladecad.arrays import Array, Mask, seal
from bladecad.deviation.inspecting.measure import Deviation, Row, row
from bladecad.deviation.nearest.referee import confirm
from bladecad.scans.finding.airfoil import Airfoil
from bladecad.scans.fitting.whole import WholeFit
from bladecad.scans.judging.support import Gap
from bladecad.scans.judging.systematic import Systematic
from bladecad.scans.judging.worst import RIM, WorstPlace
from bladecad.surface.triangulate import BladeMesh
from bladecad.tolerance import EDGE_ZONE


@final
@dataclass(frozen=True, eq=False)
class Scanned:
    """A scan, what of it is airfoil, and how the surface lies among its points.

    airfoil    : in the frame of the scan
    whole      : the fit to all points, in the frame of the files
    gaps       : places without points, in the frame of the files
    systematic : the largest mean deviation
    worst      : places where points are furthest off
    transform  : (4, 4) float, from the frame of the scan to that of the files
    """

    airfoil: Airfoil
    whole: WholeFit
    gaps: tuple[Gap, ...]
    systematic: Systematic
    worst: tuple[WorstPlace, ...]
    transform: Array

    def __post_init__(self) -> None:
        seal(self, transform=(4, 4))

    @property
    def set_aside(self) -> Mask:
        """Points of the airfoil that are outliers, (k,)."""
        return np.asarray(self.whole.weight <= 0.0)

    def table(self) -> list[Row]:
        """Deviations of the points that count, and of parts of them."""
        feet, kept = self.whole.feet, ~self.set_aside & ~self.whole.feet.rim
        inner = (feet.t >= EDGE_ZONE) & (feet.t <= 1.0 - EDGE_ZONE)
        middle = (feet.u >= RIM) & (feet.u <= 1.0 - RIM)
        groups = {
            "all that count": kept,
            "off edges and rims": kept & inner & middle,
            "leading edge": kept & (feet.t < EDGE_ZONE),
            "trailing edge": kept & (feet.t > 1.0 - EDGE_ZONE),
            "hub rim": kept & (feet.u < RIM),
            "tip rim": kept & (feet.u > 1.0 - RIM),
            "set aside": self.set_aside & ~feet.rim,
        }
        return [row(name, feet.distance[group]) for name, group in groups.items()]


def deviation_of_scan(airfoil: Airfoil, whole: WholeFit, mesh: BladeMesh) -> Deviation:
    """Measure all points of the airfoil; `section` is the nearest one, `index` that of the scan.

    Points beyond hub and tip are set aside: their distance is no deviation.

    Raises
    ------
    GeometryError
        If trimesh disagrees with the distances.
    """
    feet, lines = whole.feet, whole.fit.lines
    between = 0.5 * (lines.span[1:] + lines.span[:-1])
    return Deviation(
        whole.points, feet.distance, np.searchsorted(between, feet.u),
        np.flatnonzero(airfoil.taken), feet.suction, feet.u, feet.t, feet.rim, lines.names,
        confirm(mesh, whole.points, feet),
    )  # fmt: skip
