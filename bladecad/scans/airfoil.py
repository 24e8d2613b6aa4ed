"""What of a scan is airfoil: not its root, platform and shroud, nor what stands alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from threadpoolctl import threadpool_limits

from bladecad.arrays import Mask, Points, Vector, seal
from bladecad.data.scan import Scan
from bladecad.errors import DataError
from bladecad.scans.axis import stacking_axis
from bladecad.scans.evenly import skin
from bladecad.scans.height import Height, planes
from bladecad.scans.lonely import lonely
from bladecad.scans.slabs import Slabs
from bladecad.scans.span import cut, limits, run

ENOUGH: Final = 150_000  # points that the airfoil is found from
FEWEST: Final = 1_500
MORE: Final = 1.15  # times the points of a usual slab: platform or root, no cut-off corner


@final
@dataclass(frozen=True, eq=False)
class Airfoil:
    """What of a scan is airfoil.

    scan    : as read
    height  : how far along the span a place is
    axis    : (3,) float, unit stacking axis, from hub to tip
    low, high : mm, heights between which it is airfoil
    taken   : (k,) bool, points of the scan that are airfoil
    lonely  : (k,) bool, points that stand alone; not taken
    partial : True if it is not closed around
    notes   : what was guessed, and how to say otherwise
    """

    scan: Scan
    height: Height
    axis: Vector
    low: float
    high: float
    taken: Mask
    lonely: Mask
    partial: bool
    notes: tuple[str, ...]

    def __post_init__(self) -> None:
        seal(self, axis=(3,))

    @property
    def points(self) -> Points:
        """The points that are airfoil, (n, 3), mm."""
        return self.scan.points[self.taken]


def find_airfoil(
    scan: Scan,
    *,
    axis: Vector | None = None,
    span: tuple[float, float] | None = None,
    height: Height | None = None,
    partial: bool = False,
) -> Airfoil:
    """Find the stacking axis of a scan and the span that is airfoil.

    Parameters
    ----------
    scan : Scan
        In any pose; cloud or mesh, with or without root, platform, shroud and caps.
    axis : (3,) float, optional
        Stacking axis from hub to tip.
    span : (float, float), optional
        Heights between which it is airfoil, mm.
    height : Height, optional
        Cylinders or cones to cut along; planes across the stacking axis by default.
    partial : bool
        Take an airfoil that is not closed around.

    Raises
    ------
    DataError
        If it is no blade, or not one; it tells why.
    """
    with threadpool_limits(1):
        alone = (
            np.zeros(len(scan.points), bool) if scan.triangles is not None else lonely(scan.points)
        )
        points = skin(scan, ENOUGH, ~alone)
        notes: list[str] = []
        if height is None:
            if axis is None:
                direction, worth = stacking_axis(points)
                if worth <= 0.0:
                    raise DataError(
                        "no direction cuts the scan into slender closed loops: it is no blade"
                    )
            else:
                direction = np.asarray(axis, dtype=np.float64) / np.linalg.norm(axis)
            height = planes(direction)
        radius, middle = height.middle(points)
        flat = height.flat(points, radius, middle)
        found = cut(flat)
        taken = run(found)
        if taken is None:
            raise DataError("no blade")
        if axis is None and height.kind == "plane" and _upside_down(found, taken):
            height = planes(-height.axis)
            flat = height.flat(points, radius, middle)
            found = cut(flat)
            taken = run(found)
            assert taken is not None
        low, high, _ = limits(flat, found, taken)
        if span is not None:
            low, high = min(span), max(span)
        h = height(scan.points)
        inside = (h >= low) & (h <= high) & ~alone
        up = height.axis if height.kind == "plane" else direction_of(height, scan.points[inside])
        return Airfoil(scan, height, up, low, high, inside, alone, False, tuple(notes))


def direction_of(height: Height, points: Points) -> Vector:
    """Which way the height grows in the middle of points."""
    middle = points.mean(axis=0)
    step = 1e-4 * float(np.ptp(points, axis=0).max())
    grown = np.array([height((middle + step * e)[None])[0] for e in np.eye(3)])
    d = grown - height(middle[None])[0]
    return np.asarray(d / np.linalg.norm(d))


def _upside_down(found: Slabs, taken: Mask) -> bool:
    """Whether the hub is at the upper end: the root or platform, else the larger section."""
    which = np.flatnonzero(taken)
    first, last = which[0], which[-1]
    mean = float(np.median(found.count[which]))
    more = np.where(found.count > MORE * mean, found.count, 0.0) / mean
    below, above = more[:first].sum(), more[last + 1 :].sum()
    if max(below, above) > 4.0:
        return bool(above > below)
    return bool(found.area[last] > found.area[first])
