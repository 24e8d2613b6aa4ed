"""Where a scan has one side of the blade alone, and whether the rest is enough to build it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from bladecad.arrays import Points, Vector
from bladecad.errors import DataError
from bladecad.scans.finding.located import Located
from bladecad.scans.finding.lonely import lonely
from bladecad.scans.finding.sheets import sheets

CELLS: Final = (12, 16)  # over the height and along the chord
INNER: Final = (0.06, 0.94)  # of the chord: round edges are neither one sheet nor two
WITHIN: Final = 0.3  # of the chord from the camber line: further is no blade
BEYOND: Final = 0.2  # of span or chord, beyond either end, that is looked at
ROWS: Final = 8  # in which it is
RUN: Final = 3.0 / ROWS  # of them with one side alone: the scan goes on
MOSTLY: Final = 0.6  # of the cells of such a row
THINNER: Final = 0.5  # of the half thickness: scatter of a single sheet
MIDDLE: Final = 0.1  # of the span, left out at either end where the edges are looked at
FURTHER: Final = 0.05  # of the chord, beyond an edge: points there are no part of it
MANY: Final = 0.05  # of the points: so many beyond an edge that it is none
EDGE: Final = 0.2  # of the height of an edge that may have one side alone
FREE: Final = 0.1  # of one side that may be missing
MOST: Final = 0.5  # of a side, or of the height, that may where a partial blade is asked for
BOTH: Final = "scan the other side there, too"
ASK: Final = f"{BOTH}, or give --allow-partial to build"


@final
@dataclass(frozen=True)
class OneSided:
    """What of a blade a scan shows from one side alone.

    below, above : mm, how far the scan goes on so beyond hub and tip
    edge         : share of the height at which an edge is open, of the worse one
    share        : of one side, missing between hub and tip
    """

    below: float
    above: float
    edge: float
    share: float

    @property
    def free(self) -> bool:
        """Whether so little is missing that the blade is whole."""
        return not (self.below or self.above or self.share > FREE)


def one_sided(points: Points, found: Located) -> OneSided:
    """Tell where one side of a blade is missing.

    Parameters
    ----------
    points : (k, 3) float, mm
        Of the skin of the scan, in no order.
    found : Located
    """
    flat = found.flat(points)
    h, span = flat[:, 2], found.high - found.low
    X, across, half, chord = found.shape.off(flat)
    place, share = (X - INNER[0]) / (INNER[1] - INNER[0]), (h - found.low) / span
    near = (np.abs(across) < WITHIN * chord) & (place > 0.0) & (place < 1.0)
    inside = near & (share > 0.0) & (share < 1.0)
    cells = sheets(share[inside], place[inside], across[inside], CELLS)
    open_edge = cells.one.sum(axis=0) / np.maximum(cells.judged.sum(axis=0), 1)
    thick = float(np.median(half[inside]))
    reach = BEYOND * max(span, float(np.median(chord)))
    below, above = (
        _goes_on(off[near] / reach, place[near], across[near], thick) * reach
        for off in (found.low - h, h - found.high)
    )
    middle = (share > MIDDLE) & (share < 1.0 - MIDDLE)
    ends = 1.0 if _beyond_edges(points[middle], X[middle]) else 0.0
    return OneSided(
        below, above, max(ends, float(open_edge[0]), float(open_edge[-1])),
        float(cells.one.sum() / max(cells.judged.sum(), 1)) * (INNER[1] - INNER[0]),
    )  # fmt: skip


def _goes_on(off: Vector, place: Vector, across: Vector, thick: float) -> float:
    """How far beyond an end points reach, if there they lie on one sheet; else 0."""
    out = (off > 0.0) & (off < 1.0)
    cells = sheets(off[out], place[out], across[out], (ROWS, CELLS[1] // 2))
    single = cells.one & (cells.scatter < THINNER * thick)
    rows = single.sum(axis=1) > MOSTLY * single.shape[1]
    return float(off.max()) if rows.mean() >= RUN else 0.0


def _beyond_edges(points: Points, X: Vector) -> bool:
    """Whether many points go on beyond an end of the chord without a gap."""
    beyond, on = (X < -FURTHER) | (X > 1.0 + FURTHER), (X > 0.0) & (X < 1.0)
    if beyond.sum() < MANY * on.sum():
        return False
    island = lonely(points)[1]
    main = np.bincount(island[on]).argmax()
    return bool((beyond & (island == main)).sum() > MANY * on.sum())


def refuse_one_sided(sided: OneSided, found: Located, *, allow_partial: bool, given: bool) -> None:
    """Refuse a scan that shows too much of a blade from one side alone.

    Parameters
    ----------
    given : bool
        Whether the user gave the heights: then the scan may go on beyond them.

    Raises
    ------
    DataError
        If an edge is open, more than half is missing, or, unless a partial blade is asked for,
        more than a tenth.
    """
    span = found.high - found.low
    where = f"between the heights {found.low:.5g} and {found.high:.5g} mm"
    on = 0.0 if given else sided.below + sided.above
    if sided.edge > EDGE:
        raise DataError(
            f"the scan is open: one side of the blade is missing at an edge, over {sided.edge:.0%} "
            f"of its height {where}; where the blade ends there cannot be known: {BOTH}, or give "
            "--span for the heights at which it is closed"
        )
    if sided.share > MOST:
        raise DataError(
            f"{sided.share:.0%} of one side of the blade is missing {where}, {MOST:.0%} at most "
            f"can be bridged: {BOTH}"
        )
    if on > MOST * (span + on):
        raise DataError(
            f"the scan shows both sides of the blade {where} alone, and one side for {on:.4g} mm "
            f"more: {BOTH}, or give --span for these heights alone"
        )
    if on and not allow_partial:
        raise DataError(
            f"the scan shows both sides of the blade {where} alone, and one side for {on:.4g} mm "
            f"more: {ASK} what has both"
        )
    if sided.share > FREE and not allow_partial:
        raise DataError(
            f"{sided.share:.0%} of one side of the blade is missing {where}, {FREE:.0%} at most is "
            f"bridged unasked: {ASK} it so"
        )
