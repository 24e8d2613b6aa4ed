"""What of a scan is airfoil: not its root, platform and shroud, nor what stands alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Mask, Points, Vector, seal
from bladecad.data.scan import Scan
from bladecad.errors import DataError
from bladecad.one_thread import one_thread
from bladecad.scans.finding.beyond import left_beyond
from bladecad.scans.finding.evenly import skin
from bladecad.scans.finding.height import Height
from bladecad.scans.finding.located import Located, located
from bladecad.scans.finding.lonely import lonely
from bladecad.scans.finding.one_sided import one_sided, refuse_one_sided
from bladecad.scans.finding.partial import Beside, Partial
from bladecad.scans.finding.refusals import refuse_few_or_flat, several_blades
from bladecad.scans.finding.several import NONE, Several, loose, on_a_hub
from bladecad.scans.finding.skeleton import Skeleton

ENOUGH: Final = 150_000  # points that the airfoil is found from
FAR: Final = 0.05  # of the chord: points further from the airfoil are no part of it
BLOCK: Final = 400_000  # points that are looked at at once


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
    notes   : what was guessed, and how to say otherwise
    partial : what was left or is bridged, of a scan that shows more or less than one blade
    """

    scan: Scan
    height: Height
    axis: Vector
    low: float
    high: float
    taken: Mask
    lonely: Mask
    notes: tuple[str, ...]
    partial: Partial | None = None

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
    allow_partial: bool = False,
) -> Airfoil:
    """Find the stacking axis of a scan and the span that is airfoil.

    Parameters
    ----------
    scan : Scan
        In any pose; cloud or mesh, with or without root, platform, shroud and caps. Nothing is
        asked of the triangles of a mesh but where they are.
    axis : (3,) float, optional
        Stacking axis from hub to tip.
    span : (float, float), optional
        Heights between which it is airfoil, mm: the coordinate along the axis or, if it is not
        given, along the one found, in the sense in which its largest component is positive.
    height : Height, optional
        Cylinders or cones to cut along; planes across the stacking axis by default.
    allow_partial : bool
        Take one of several blades, the one with the most points, or the part of a blade that has
        both sides; bridge up to half of a side.

    Raises
    ------
    DataError
        If it is no blade, or not one; it tells why.
    """
    with one_thread():
        alone, island = _alone(scan)
        find = partial(located, axis=axis, span=span, height=height)
        found, points, blades, other = _one_blade(scan, alone, island, find, allow_partial)
        sided = one_sided(points, found)
        refuse_one_sided(sided, found, allow_partial=allow_partial, given=span is not None)
        more = left_beyond(points, found) if span is None and sided.free else ()
        inside, far = _inside(scan.points, found, alone | other)
    if inside.sum() == 0:
        raise DataError(
            f"no point of the scan lies between the heights {found.low:.4g} and "
            f"{found.high:.4g} mm; give another --span"
        )
    left = Partial(blades, sided) if blades or not sided.free else None
    return Airfoil(
        scan, found.height, found.axis, found.low, found.high, inside, alone,
        (*(left.notes if left else ()), *found.notes, *more, *_said(scan, alone, far)), left,
    )  # fmt: skip


def _one_blade(
    scan: Scan,
    alone: Mask,
    island: NDArray[np.int64],
    find: Callable[[Points], Located],
    allow_partial: bool,
) -> tuple[Located, Points, tuple[Beside, ...], Mask]:
    """A blade, points of its skin, the blades where there are several, and points of the others."""
    points = skin(scan, ENOUGH, ~alone)
    refuse_few_or_flat(points)
    several = loose(scan.points[~alone], island[~alone]) if scan.triangles is None else NONE
    if several.blades > 1 and not allow_partial:
        raise several_blades(several.blades)
    if several.blades < 2:
        try:
            return find(points), points, (), np.zeros(len(scan.points), bool)
        except DataError:
            several = on_a_hub(points) if allow_partial else NONE
            if several.blades < 2:
                raise
    blades, other = _beside(scan.points, several, alone)
    points = skin(scan, ENOUGH, ~(alone | other))
    return find(points), points, blades, other


def _beside(points: Points, several: Several, alone: Mask) -> tuple[tuple[Beside, ...], Mask]:
    """The blades of a scan, most points first, and which points are not of the first."""
    whose = several.whose(points)
    held = np.bincount(whose[~alone], minlength=several.blades)[: several.blades]
    order = np.argsort(-held, kind="stable")
    blades = [Beside(int(held[k]), several.parts[k].mean(axis=0)) for k in order]
    return tuple(blades), np.asarray(whose != order[0])


def _alone(scan: Scan) -> tuple[Mask, NDArray[np.int64]]:
    if scan.triangles is None:
        return lonely(scan.points)
    return np.zeros(len(scan.points), bool), np.zeros(len(scan.points), np.int64)


def _inside(points: Points, found: Located, not_its: Mask) -> tuple[Mask, int]:
    """Which points are airfoil, and how many at its heights are far from it."""
    inside = np.zeros(len(points), bool)
    far = 0
    for first in range(0, len(points), BLOCK):
        block = slice(first, first + BLOCK)
        h = found.height(points[block])
        at = np.flatnonzero((h >= found.low) & (h <= found.high) & ~not_its[block])
        near = _near(found.flat(points[block][at]), found.shape)
        inside[first + at[near]] = True
        far += int((~near).sum())
    return inside, far


def _near(flat: Points, shape: Skeleton) -> Mask:
    X, across, half, chord = shape.off(flat)
    return np.asarray((np.abs(across) < half + FAR * chord) & (np.abs(X - 0.5) < 0.5 + FAR))


def _said(scan: Scan, alone: Mask, far: int) -> tuple[str, ...]:
    notes = []
    if alone.any():
        notes.append(f"{alone.sum()} points stand alone, away from all others; left out")
    if far:
        what = "vertices" if scan.triangles is not None else "points"
        notes.append(
            f"{far} {what} at the heights of the airfoil are further than {FAR:.0%} of the chord "
            "from it; left out"
        )
    return tuple(notes)
