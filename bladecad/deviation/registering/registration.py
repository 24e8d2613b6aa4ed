"""Registration: the scan laid onto the nominal, and what that absorbed."""

from __future__ import annotations

import logging
from collections.abc import Collection
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Final, Literal, final

import numpy as np
from scipy.spatial.transform import Rotation

from bladecad.arrays import Array, Points, Vector, seal
from bladecad.deviation.nearest.nominal import Nominal
from bladecad.deviation.registering.align import Aligned, Frame, align, sized, standing
from bladecad.deviation.registering.pose import FREEDOMS, Freedom, free_of, moved
from bladecad.deviation.registering.refuse import (
    refuse_elsewhere,
    refuse_few_or_flat,
    refuse_grown,
    refuse_loose,
    refuse_other,
    refuse_size,
)
from bladecad.deviation.registering.remarks import remark_on_size, remarks
from bladecad.deviation.registering.stand_in import StandIn, stand_in
from bladecad.deviation.registering.starts import find_start
from bladecad.errors import DataError, ToleranceError

Kind = Literal["none", "best"]

FEW, SOME, MOST = 3_000, 50_000, 1_000_000  # points of the three stages
ROUNDS: Final = (25, 6, 2)  # projections at most, in each
ENOUGH = 1e-4  # of the chord: after a step like this the feet of all points need not be renewed
SUSPECT = 5e-4  # of the chord: a residual at which the mirror image is looked at too
UNSURE = 1e-4  # of the chord: a residual at which another size is tried
MIRROR: Final = np.array([1.0, 1.0, -1.0])

log = logging.getLogger(__name__)


@final
@dataclass(frozen=True, eq=False)
class Registration:
    """Where the scan was put, and how well it lies there.

    T_nominal_scan : (4, 4) float, mm: x in the frame of the scan goes to R x + p in the nominal's
    kind       : "none", as it came, or "best", the best fit
    locked     : coordinates of T, shift p and rotation vector, that were kept at zero
    covariance : (6, 6) float, of shift (mm) at `centre` and rotation (rad), in the axes of the
                 nominal; from the noise alone, as if independent from point to point
    centre     : (3,) float, mm, in the frame of the nominal: centre of its sides
    rms, largest : mm, distances of the points used: those within the span and nearer than a
                 twentieth of the chord, of at most a million drawn from the scan
    scale      : mm, their robust standard deviation
    used, beyond, far : how many of these were used, stand beyond the span, and are too far off
    steps      : Gauss-Newton steps of the last stage
    projected  : points projected, all steps together
    notes      : what the reader should know, as sentences
    """

    T_nominal_scan: Array
    kind: Kind
    locked: tuple[Freedom, ...]
    covariance: Array
    centre: Vector
    rms: float
    largest: float
    scale: float
    used: int
    beyond: int
    far: int
    steps: int
    projected: int
    notes: tuple[str, ...]

    def __post_init__(self) -> None:
        seal(self, T_nominal_scan=(4, 4), covariance=(6, 6), centre=(3,))

    @property
    def shift(self) -> Vector:
        """How far the material at `centre` was moved, (3,), mm."""
        R, p = self.T_nominal_scan[:3, :3], self.T_nominal_scan[:3, 3]
        return np.asarray(self.centre - R.T @ (self.centre - p))

    @property
    def rotation(self) -> Vector:
        """Rotation vector of T, (3,), rad."""
        return np.asarray(Rotation.from_matrix(self.T_nominal_scan[:3, :3]).as_rotvec())

    @property
    def angle(self) -> float:
        """Angle by which the scan was turned, rad."""
        return float(np.linalg.norm(self.rotation))

    @property
    def deviations(self) -> Vector:
        """Standard deviations of shift (mm) and rotation (rad), (6,)."""
        return np.asarray(np.sqrt(np.diag(self.covariance)))


def register(
    nominal: Nominal, points: Points, *, fit: Kind = "best", locked: Collection[Freedom] = ()
) -> Registration:
    """Lay a scan onto the nominal, from wherever it stands.

    Minimises sum_i rho(d_i / s) over rigid motions, d_i the distance to the nominal, rho Cauchy's
    and s the robust scale: `align`. The start is found by `find_start`; then 3 thousand, 50
    thousand and all points, at most a million, are let down onto the blade.

    Parameters
    ----------
    nominal : Nominal
    points : (k, 3) float, mm
        Of the whole blade or a part of it, with or without root and platform, in any frame.
    fit : {"best", "none"}
        "none" takes the scan as it stands, and looks at 50 thousand points.
    locked : collection of {"x", "y", "z", "rx", "ry", "rz"}
        Coordinates of the pose that stay zero: of p, the shift of the origin, and of the rotation
        vector, in the frame of the nominal. The scan must be in place as far as they go.

    Raises
    ------
    DataError
        If there are too few points, on a line or plane; in another unit; mirrored; of another
        blade; or if some motion changes no distance.
    ToleranceError
        If a locked coordinate is unknown, or all six are locked.
    """
    names = _locked(locked)
    points = np.asarray(points, dtype=np.float64)
    refuse_few_or_flat(_drawn(points, SOME))
    cloud = stand_in(nominal.surface)
    refuse_size(cloud, _drawn(points, FEW))
    frame = Frame(cloud.centre, cloud.reach, cloud.chord, free_of(names))
    if fit == "none":
        return _as_it_stands(nominal, points, frame)
    return _best(nominal, points, cloud, frame, names)


def apply(registration: Registration, points: Points) -> Points:
    """The points of the scan in the frame of the nominal, (k, 3), mm."""
    return moved(registration.T_nominal_scan, points)


def _locked(locked: Collection[Freedom]) -> tuple[Freedom, ...]:
    unknown = [name for name in locked if name not in FREEDOMS]
    if unknown:
        raise ToleranceError(f'"{unknown[0]}" cannot be locked; one of {", ".join(FREEDOMS)} can')
    if set(locked) == set(FREEDOMS):
        raise ToleranceError('all six coordinates are locked; take the scan as it stands, "none"')
    return tuple(name for name in FREEDOMS if name in locked)


def _drawn(points: Points, count: int) -> Points:
    """At most so many points, at random, the same ones every time."""
    if len(points) <= count:
        return points
    drawn = np.random.default_rng(len(points)).choice(len(points), count, replace=False)
    return points[drawn]


def _best(
    nominal: Nominal, points: Points, cloud: StandIn, frame: Frame, locked: tuple[Freedom, ...]
) -> Registration:
    few = _drawn(points, FEW)
    found, note = _first(nominal, few, cloud, frame, locked)
    counts = [found.rounds * len(few)]
    for count, rounds in ((SOME, ROUNDS[1]), (MOST, ROUNDS[2])):
        if len(few) < min(len(points), count):
            few = _drawn(points, count)
            enough = ENOUGH * frame.chord if count == MOST else 0.0
            found = align(nominal, few, found.T, frame, rounds=rounds, enough=enough)
            counts.append(found.rounds * len(few))
    log.info("registered %d points, %s projected, rms %.3g mm", len(points), counts, found.rms)
    return _told(found, "best", locked, frame, sum(counts), note)


def _first(
    nominal: Nominal, few: Points, cloud: StandIn, frame: Frame, locked: tuple[Freedom, ...]
) -> tuple[Aligned, tuple[str, ...]]:
    """A few points laid down; refused if they are of no such blade, or slide on it."""
    found, image = _laid(nominal, few, cloud, frame), None
    if found is None or found.scale > SUSPECT * frame.chord:
        image = _laid(nominal, few * MIRROR, cloud, replace(frame, free=free_of(())))
    found = refuse_other(found, image, frame, locked)
    refuse_loose(found, frame)
    if found.scale <= UNSURE * frame.chord:
        return found, ()
    size, grown = sized(nominal, few, found, frame)
    refuse_grown(found, grown, size)
    return found, remark_on_size(found, grown, size)


def _laid(nominal: Nominal, few: Points, cloud: StandIn, frame: Frame) -> Aligned | None:
    """The best of the starts let down; None if at none of them points lie on the blade."""
    start = find_start(cloud, few, frame.free)
    found = []
    for T in (start.T, *start.others):
        with suppress(DataError):
            found.append(align(nominal, few, T, frame, rounds=ROUNDS[0]))
    return min(found, key=lambda a: a.cost(frame), default=None)


def _as_it_stands(nominal: Nominal, points: Points, frame: Frame) -> Registration:
    """No motion; refused if most points stand nowhere near the blade."""
    some = _drawn(points, SOME)
    found = None
    with suppress(DataError):
        found = standing(nominal, some, frame)
    found = refuse_elsewhere(found, frame)
    return _told(found, "none", (), frame, len(some))


def _told(
    found: Aligned,
    kind: Kind,
    locked: tuple[Freedom, ...],
    frame: Frame,
    projected: int,
    notes: tuple[str, ...] = (),
) -> Registration:
    return Registration(
        T_nominal_scan=found.T,
        kind=kind,
        locked=locked,
        covariance=found.covariance,
        centre=frame.centre,
        rms=found.rms,
        largest=float(np.abs(found.residual).max()),
        scale=found.scale,
        used=len(found.residual),
        beyond=found.met.rim,
        far=found.met.far,
        steps=found.rounds,
        projected=projected,
        notes=(*notes, *remarks(found, frame)),
    )
