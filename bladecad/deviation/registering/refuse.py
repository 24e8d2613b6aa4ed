"""Scans that are not of this blade, or not as they should be: found, named, refused."""

from __future__ import annotations

from typing import Final

import numpy as np

from bladecad.arrays import Points
from bladecad.data.sections import MM_PER, Unit
from bladecad.deviation.registering.align import GATE, Aligned, Frame
from bladecad.deviation.registering.pose import Freedom
from bladecad.deviation.registering.remarks import motion, to_lock
from bladecad.deviation.registering.stand_in import StandIn, reach, thinned
from bladecad.deviation.registering.starts import find_start
from bladecad.errors import DataError

LEAST = 50  # points: six unknowns, a robust scale, and some to spare
FLAT = 1e-3  # of the largest extent: thinner clouds are lines or planes
SIZES: Final = (0.2, 5.0)  # times the nominal: a part of the blade, or a blade on its disc
LIKELY: Final = (0.4, 3.0)  # times the nominal, once the unit is right
FITS = 0.2  # badness below which a pose says that this is the blade
OTHER_BLADE = 0.004  # of the chord, robust: a blade 2 % out at its worst place has half of it
GROWTH = 0.02  # of the size: what shrinking and heat explain
BETTER = 0.5  # times the residual: a mirror image that lies so much closer is the blade
ELSEWHERE = 0.5  # of the points
LOOSE = 1e-3  # mm of distance, rms, by a motion of 1 mm
UNIT_WORDS: Final[dict[Unit, str]] = {
    "cm": "centimetres",
    "m": "metres",
    "in": "inches",
    "ft": "feet",
}


def refuse_few_or_flat(points: Points) -> None:
    """Refuse scans from which no pose can be told.

    Raises
    ------
    DataError
        If they are few, not finite, or lie on one place, line or plane.
    """
    if len(points) < LEAST:
        raise DataError(f"the scan has {len(points)} points, {LEAST} are needed to register it")
    bad = ~np.isfinite(points).all(axis=1)
    if bad.any():
        raise DataError(f"{bad.sum()} points of the scan are not finite; drop them first")
    size = np.linalg.svd(points - points.mean(axis=0), compute_uv=False) / np.sqrt(len(points))
    if size[2] <= FLAT * size[0]:
        where = "at one place" if size[0] == 0 else "on one line"
        where = "on one plane" if size[1] > FLAT * size[0] else where
        raise DataError(
            f"the points of the scan lie {where}: {size[2]:.3g} mm rms across it, more than "
            f"{FLAT * size[0]:.3g} mm is needed to register them; scan both sides, over the span"
        )


def refuse_size(stand_in: StandIn, points: Points) -> None:
    """Refuse scans in another unit.

    Raises
    ------
    DataError
        If the scan is five times smaller or larger than the nominal; it names the unit in which
        the scan lies on it, or is nearest in size.
    """
    ratio = reach(thinned(points)) / stand_in.reach
    if SIZES[0] <= ratio <= SIZES[1]:
        return
    told = f"the scan is {ratio:.3g} times as large as the nominal"
    fitting = sorted((abs(np.log(ratio * k)), k, name) for k, name in _units())
    for _, k, name in fitting:
        alike = LIKELY[0] <= ratio * k <= LIKELY[1]
        if alike and find_start(stand_in, points * k, np.ones(6, bool)).badness < FITS:
            raise DataError(f"{told}, and lies on it when {name}")
    _, k, name = fitting[0]
    raise DataError(
        f"{told}, {SIZES[0]:g} to {SIZES[1]:g} times is allowed; {ratio * k:.3g} times when "
        f"{name}; is it a scan of this blade?"
    )


def refuse_other(
    found: Aligned | None, image: Aligned | None, frame: Frame, locked: tuple[Freedom, ...]
) -> Aligned:
    """Refuse scans of another blade; `found` comes back if it is of this one.

    Parameters
    ----------
    found, image : Aligned or None
        How the scan lies on the nominal, and how its mirror image does; None where hardly a point
        lies near. The image is looked at only where the scan does not fit well.
    frame : Frame
    locked : tuple
        What may not move, for the message.

    Raises
    ------
    DataError
        If its mirror image fits far better, or it does not fit.
    """
    bound = OTHER_BLADE * frame.chord
    mine = found.scale if found else np.inf
    if image is not None and image.scale < min(bound, BETTER * mine):
        raise DataError(
            f"the scan is mirrored: its mirror image lies on the nominal to {image.scale:.3g} mm "
            f"(robust), the scan itself to {mine:.3g} mm; change the sign of one axis of the scan, "
            "or take the nominal of the other hand"
        )
    if found is None or found.scale > bound or found.met.far > len(found.residual):
        far = f"{found.scale:.3g}" if found else f"more than {GATE * frame.chord:.3g}"
        free = f" with {', '.join(locked)} locked" if locked else ""
        raise DataError(
            f"the scan is of another blade: at best it stands {far} mm (robust) from the "
            f"nominal{free}, {bound:.3g} mm is allowed, {100 * OTHER_BLADE:.2g} % of the chord of "
            f"{frame.chord:.3g} mm; check which nominal and scan belong together, and the unit"
        )
    return found


def refuse_grown(found: Aligned, grown: Aligned, size: float) -> None:
    """Refuse scans of a blade of the same shape in another size.

    Raises
    ------
    DataError
        If the scan lies far better when it is made larger or smaller by some hundredths.
    """
    if grown.scale < BETTER * found.scale and abs(size - 1.0) > GROWTH:
        raise DataError(
            f"the scan is of a blade of another size: made {size:.3f} times as large it lies on "
            f"the nominal to {grown.scale:.2g} mm (robust), as it is to {found.scale:.2g} mm; "
            f"{100 * GROWTH:g} % of size is allowed, check which nominal and scan belong together"
        )


def refuse_elsewhere(found: Aligned | None, frame: Frame) -> Aligned:
    """Refuse scans taken as they stand that do not stand on the nominal; `found` comes back.

    Raises
    ------
    DataError
        If half of the points are too far from it.
    """
    share = found.met.far / (found.met.far + found.met.rim + len(found.residual)) if found else 1.0
    if found is None or share > ELSEWHERE:
        raise DataError(
            f"{100 * share:.0f} % of the points stand further than {GATE * frame.chord:.3g} mm "
            f"from the nominal, {100 * ELSEWHERE:.0f} % is allowed of a scan that is not moved; "
            "its frame is another one, register it with --fit best"
        )
    return found


def refuse_loose(found: Aligned, frame: Frame) -> None:
    """Refuse scans whose pose is not determined.

    Raises
    ------
    DataError
        If some motion changes hardly any distance; it tells which.
    """
    if found.stiffness[0] < LOOSE:
        raise DataError(
            f"the pose is not determined: {motion(found.slack, frame)} changes the distances by "
            f"only {1e3 * found.stiffness[0]:.2g} um a mm (rms), {1e3 * LOOSE:g} um is needed; "
            f"scan more of the blade, or lock {to_lock(found.slack, frame)}"
        )


def _units() -> list[tuple[float, str]]:
    """Factors on the points, and what they mean."""
    found = []
    for unit, word in UNIT_WORDS.items():
        k = MM_PER[unit]
        found.append((k, f"its lengths are multiplied by {k:g}: they are {word}, not mm; "
                         f"give --units {unit}"))  # fmt: skip
        found.append((1.0 / k, f"its lengths are divided by {k:g}: they are mm, not {word}; "
                               "give --units mm"))  # fmt: skip
    return found
