"""Between which heights a scan is airfoil: slices that follow the trend of the others, complete."""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Mask, Points, Vector
from bladecad.scans.finding.skeleton import Skeleton, legendre, robust, skeleton
from bladecad.scans.finding.slabs import FEWEST, Slabs, alike, longest_run, slabs

Counts = NDArray[np.int64]

A_SLAB: Final = 1_200  # points, where there are enough
SLABS: Final = (30, 120)  # over the scan
CHANGES: Final = (0.05, 0.10)  # of ln chord and ln area from slab to slab, at most
TREND: Final = 3  # degree of the trend of ln chord and ln area
LEAVES: Final = (0.008, 0.014)  # by which chord and area may leave it: fillets, missing corners
CLEAR: Final = 4.0  # times their scatter
CORE: Final = 0.7  # of the run, in its middle, that the trend begins from
SHORTEST: Final = 5  # slabs
HOLED: Final = 0.97  # times the usual points: a slab with a hole
PASSED: Final = 30  # slabs that may be passed over
LIKE: Final = 0.6  # of the usual quality: slabs that it may go on with behind them
LOCAL: Final = 12  # slabs that the next one is foretold from
CELLS: Final = 40  # along the chord, on each side, in which the rim is looked for
NEAR: Final = 0.25  # of the half thickness: points that lie on the airfoil
OFF: Final = 0.004  # of the chord, as well
RIM: Final = 3  # degree of the rim along the chord
MORE: Final = 1.15  # times the points of a usual slab, or
LARGER: Final = (1.3, 1.08)  # times area and chord of the end of the airfoil
NEXT: Final = 5  # slabs at its end
CAP: Final = 2  # slabs that a cap may fill
RETREAT: Final = 0.1  # slabs left out beside a fillet
CLEAR_OF_EDGES: Final = 0.03  # of the chord, where the rough shape tells no fillet
SEVERAL: Final = 4  # cells that must have left it
FULL: Final = 6  # points of a cell whose median counts
THICKER: Final = 6.0  # times the scatter, by which a cell leaves its trend
GROWN: Final = 0.03  # of the half thickness, at least
TILT: Final = 0.06  # of the rise of a rim: what it may be misjudged by
HOLE: Final = 2.0  # slabs by which a rim that has a hole dips
INSET: Final = 0.003  # of the span, left out at a rim


def cut(flat: Points) -> Slabs:
    """Cut points into slabs, as thin as their number allows."""
    count = int(np.clip(len(flat) // A_SLAB, *SLABS))
    low, high = float(flat[:, 2].min()), float(flat[:, 2].max())
    return slabs(flat, np.linspace(low, high + 1e-9 * (high - low), count + 1))


def run(found: Slabs) -> Mask | None:
    """Slabs that are airfoil: the best run of sections, without those that leave the trend."""
    first, last = longest_run(alike(found, *CHANGES), found.quality * found.count)
    if last - first + 1 < SHORTEST:
        return None
    return _on_trend(found, first, last)


def _on_trend(found: Slabs, first: int, last: int) -> Mask:
    """The slabs of a run that follow the trend of its middle, and on from there."""
    values = np.log(np.stack([found.chord, found.area], axis=1))
    k = np.arange(len(values))
    middle, half = 0.5 * (first + last), 0.5 * (last - first)
    good = np.abs(k - middle) <= CORE * half
    A = legendre(np.asarray((k - middle) / half, dtype=np.float64), TREND)
    off = np.stack([np.abs(v - A @ robust(A[good], v[good])) for v in values.T], axis=1)
    bound = np.maximum(LEAVES, CLEAR * 1.4826 * np.median(off[good], axis=0))
    good = _joined((off <= bound).all(axis=1) & (k >= first) & (k <= last), round(middle))
    which = np.flatnonzero(good)
    low, high = int(which[0]), int(which[-1])
    like = found.quality > LIKE * float(np.median(found.quality[good]))
    holed = (found.quality > 0.0) & (found.count < HOLED * np.median(found.count[good]))
    back = _grown(
        values[: high + 1][::-1], like[: high + 1][::-1], holed[: high + 1][::-1], high - low, bound
    )
    on = _grown(values[low:], like[low:], holed[low:], high - low, bound)
    return np.asarray((k >= high - back) & (k <= low + on))


def _grown(values: Array, like: Mask, holed: Mask, begin: int, bound: Vector) -> int:
    """Number of the last slab that goes on as those before it do.

    Slabs that do not are passed over, be it a hole or a shroud, where those behind them do again;
    those with points missing need only have the chord.
    """
    k, before = begin, list(range(begin + 1))
    while k < len(values) - 1:
        off = _off(values, np.array(before), k, np.array([k + 1]), 2)[0]
        if (off <= bound).all():
            k += 1
        else:
            ahead = np.arange(k + 2, min(k + 2 + PASSED, len(values)))
            off = _off(values, np.array(before), k, ahead, 1)
            wider = np.maximum(1.0, 2.0 * (ahead - k) / LOCAL)[:, None]
            fits = (off <= bound * wider).all(axis=1) & like[ahead]
            again = np.flatnonzero(fits[2:] & fits[1:-1] & fits[:-2])
            if len(again) == 0:
                break
            k = int(ahead[again[0]])
        before.append(k)
    while k < len(values) - 1 and holed[k + 1]:
        if _off(values[:, :1], np.array(before), k, np.array([k + 1]), 1)[0] > bound[0]:
            break
        k += 1
    return k


def _off(values: Array, before: Counts, k: int, ahead: Counts, degree: int) -> Array:
    """How far values ahead are off the line, or parabola, through those before."""
    near = before[-LOCAL * (3 - degree) :]
    powers = np.arange(degree + 1.0)
    c = robust(((near - k) / LOCAL)[:, None] ** powers, values[near])
    return np.asarray(np.abs(values[ahead] - ((ahead - k) / LOCAL)[:, None] ** powers @ c))


def _joined(fits: Mask, middle: int) -> Mask:
    """Slabs about the middle, up to two neighbours in a row that do not fit, or the last."""
    bad = ~fits
    twice = bad & np.append(bad[1:], True)
    after = np.flatnonzero(twice[middle:])
    twice = bad & np.append(True, bad[:-1])
    before = np.flatnonzero(twice[: middle + 1])
    out = np.zeros(len(fits), bool)
    out[
        (before[-1] + 1 if len(before) else 0) : (middle + after[0] if len(after) else len(fits))
    ] = True
    return out


def limits(flat: Points, found: Slabs, taken: Mask) -> tuple[float, float, Skeleton]:
    """Heights between which all of the outline is there, and the rough shape between them."""
    shape = skeleton(flat, found, taken)
    step = float(found.borders[1] - found.borders[0])
    X, across, half, chord = shape.off(flat)
    on = np.abs(np.abs(across) - half) <= NEAR * half + 3.0 * shape.misfit + OFF * chord
    on &= (X > 0.0) & (X < 1.0)
    cell = np.clip((X * CELLS).astype(np.int64), 0, CELLS - 1) + CELLS * (across > 0.0)
    which = np.flatnonzero(taken)
    ends = []
    for way, last in ((-1, which[0]), (1, which[-1])):
        border = float(way * found.borders[last + (way > 0)])
        h = way * flat[:, 2] - border
        if beyond(found, taken)[int(way > 0)] > CAP:
            near = (np.abs(h) < 20.0 * step) & (np.abs(across) < 3.0 * half + OFF * chord)
            near &= (X > CLEAR_OF_EDGES) & (X < 1.0 - CLEAR_OF_EDGES)
            thick = (np.abs(across) - half)[near]
            ends.append(
                border + _fillet(h[near] / step, thick, cell[near], float(np.median(half))) * step
            )
        else:
            near = on & (h < step) & (h > -8.0 * step)
            rim, slope = _rim(h[near], cell[near], step)
            inset = INSET * (shape.high - shape.low)
            ends.append(border + min(rim, step) - TILT * slope - inset)
    return -ends[0], ends[1], shape


def beyond(found: Slabs, taken: Mask) -> tuple[int, int]:
    """How many slabs below and above the airfoil are larger than it: of a root, a platform."""
    which = np.flatnonzero(taken)
    more = found.count > MORE * float(np.median(found.count[which]))
    sides = []
    for end, side in (
        (which[:NEXT], slice(0, which[0])),
        (which[-NEXT:], slice(which[-1] + 1, None)),
    ):
        area, chord = (float(np.median(v[end])) for v in (found.area, found.chord))
        larger = (found.area > LARGER[0] * area) | (found.chord > LARGER[1] * chord)
        sides.append(int((more | (larger & (found.count >= FEWEST)))[side].sum()))
    return sides[0], sides[1]


def _fillet(height: Vector, thick: Vector, cell: Counts, usual: float) -> float:
    """Where a fillet begins, in slabs over the border: a cell grows thicker than its trend."""
    slab = np.floor(height).astype(np.int64) + 20
    keys = cell * 40 + slab
    order = np.argsort(keys, kind="stable")
    cells, firsts, counts = np.unique(keys[order], return_index=True, return_counts=True)
    middle = np.full((2 * CELLS, 40), np.nan)
    for key, first, count in zip(cells, firsts, counts, strict=True):
        if count >= FULL:
            middle[divmod(int(key), 40)] = np.median(thick[order[first : first + count]])
    below = np.arange(2, 17)
    inner = middle[:, below]
    rows = np.isfinite(inner).sum(axis=1) >= 10
    if not rows.any():
        return -RETREAT
    off = np.array([_off_trend(row) for row in middle[rows]])
    own = 1.4826 * np.nanmedian(np.abs(off[:, below]), axis=1, keepdims=True)
    bound = np.maximum(THICKER * np.maximum(own, np.median(own)), GROWN * usual)
    share = off / bound
    share[np.isnan(share)] = np.inf
    inwards = share[np.isfinite(off[:, 20]), 22:1:-1]  # from beyond the border
    inwards = inwards[(inwards > 1.0).all(axis=1, where=np.arange(21) < 2)]
    first = np.argmin(inwards > 1.0, axis=1)  # the first that is as it should be
    ends = [_crossing(row, k) for row, k in zip(inwards, first, strict=True)]
    begin = 2.5 - sorted(ends)[-min(SEVERAL, len(ends))] if ends else 0.0
    return min(begin, 0.0) - RETREAT


def _crossing(inwards: Vector, k: int) -> float:
    """Between values k - 1, over 1, and k, under 1: where 1 is crossed."""
    over, under = inwards[k - 1], inwards[k]
    return float(k - (1.0 - under) / (over - under)) if np.isfinite(over) else float(k)


def _off_trend(row: Vector) -> Vector:
    """How far the values of a cell are off the parabola through its inner ones."""
    k = np.arange(40.0)
    inner = np.isfinite(row) & (k >= 2) & (k < 17)
    A = ((k - 10.0) / 10.0)[:, None] ** np.arange(3.0)
    return np.asarray(row - A @ robust(A[inner], row[inner]))


def _rim(height: Vector, cell: Counts, step: float) -> tuple[float, float]:
    """Lowest place of the upper rim, but for holes, and how much it rises from there."""
    top = np.full(2 * CELLS, -np.inf)
    np.maximum.at(top, cell, height)
    there = np.isfinite(top)
    if there.sum() < CELLS:
        return 0.0, 0.0
    place = (np.arange(CELLS) + 0.5) / CELLS * 2.0 - 1.0
    A = np.kron(np.eye(2), legendre(place, RIM))
    low = there.copy()
    for _ in range(5):
        c = robust(A[low], top[low])
        off = top - A @ c
        low = there & (off > -max(4.0 * float(np.median(np.abs(off[low]))), HOLE * step))
    corners = np.kron(np.eye(2), legendre(np.array([-1.0, 1.0]), RIM)) @ c
    lowest, highest = min(top[low].min(), corners.min()), max(top[low].max(), corners.max())
    return float(lowest), float(highest - lowest)
