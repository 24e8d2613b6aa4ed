"""Between which heights a scan is airfoil: slices that follow the trend of the others, complete."""

from __future__ import annotations

from typing import Final

import numpy as np

from bladecad.arrays import Array, Mask, Points, Vector
from bladecad.scans.skeleton import Skeleton, legendre, robust, skeleton
from bladecad.scans.slabs import Slabs, alike, longest_run, slabs

A_SLAB: Final = 1_200  # points, where there are enough
SLABS: Final = (30, 120)  # over the scan
CHANGES: Final = (0.05, 0.10)  # of ln chord and ln area from slab to slab, at most
TREND: Final = 3  # degree of the trend of ln chord and ln area
LEAVES: Final = (0.008, 0.014)  # by which chord and area may leave it: fillets, missing corners
CLEAR: Final = 4.0  # times their scatter
CORE: Final = 0.7  # of the run, in its middle, that the trend begins from
SHORTEST: Final = 5  # slabs
LOCAL: Final = 12  # slabs that the next one is foretold from
CELLS: Final = 40  # along the chord, on each side, in which the rim is looked for
NEAR: Final = 0.25  # of the half thickness: points that lie on the airfoil
OFF: Final = 0.004  # of the chord, as well
RIM: Final = 3  # degree of the rim along the chord
MORE: Final = 1.15  # times the points of a usual slab: a platform or a root
RETREAT: Final = 0.7  # slabs left out beside a fillet
HOLE: Final = 2.0  # slabs by which a rim that has a hole dips
INSET: Final = 0.002  # of the span, left out at a rim


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
    A = legendre((k - middle) / half, TREND)
    off = np.stack([np.abs(v - A @ robust(A[good], v[good])) for v in values.T], axis=1)
    bound = np.maximum(LEAVES, CLEAR * 1.4826 * np.median(off[good], axis=0))
    good = _joined((off <= bound).all(axis=1) & (k >= first) & (k <= last), round(middle))
    which = np.flatnonzero(good)
    low, high = int(which[0]), int(which[-1])
    back = _grown(values[: high + 1][::-1], high - low, high - first, bound)
    on = _grown(values[low:], high - low, last - low, bound)
    return np.asarray((k >= high - back) & (k <= low + on))


def _grown(values: Array, begin: int, most: int, bound: Vector) -> int:
    """Number of the last slab, at most `most`, that goes on as those before it do."""
    k = begin
    while k < most:
        before = np.arange(max(k + 1 - LOCAL, 0), k + 1)
        c = robust((before[:, None] - k) ** np.arange(3.0), values[before])
        ahead = np.arange(k + 1, min(k + 2, most) + 1)
        off = np.abs(values[ahead] - ((ahead[:, None] - k) ** np.arange(3.0)) @ c)
        if (off[0] > bound).any() and (off[-1] > bound).any():
            break
        k += 1 if (off[0] <= bound).all() else 2
    return min(k, most)


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
    h, usual = flat[:, 2], float(np.median(found.count[taken]))
    which = np.flatnonzero(taken)
    beyond = found.count[: which[0]], found.count[which[-1] + 1 :]
    ends = []
    for way, border, more in ((-1.0, shape.low, beyond[0]), (1.0, shape.high, beyond[1])):
        if (more > MORE * usual).sum() > 2:  # a root or a platform: none of its fillet
            ends.append(way * border - RETREAT * step)
            continue
        near = on & (way * (h - border) < step) & (way * (h - border) > -8.0 * step)
        rim = _rim(way * h[near], cell[near], step)
        ends.append(way * border if rim is None else min(rim, way * border + step))
    low, high = -ends[0], ends[1]
    inset = INSET * (high - low)
    return low + inset, high - inset, shape


def _rim(height: Vector, cell: Vector, step: float) -> float | None:
    """Lowest place of the upper rim, but for holes; None where there are too few points."""
    top = np.full(2 * CELLS, -np.inf)
    np.maximum.at(top, cell, height)
    there = np.isfinite(top)
    if there.sum() < CELLS:
        return None
    place = (np.arange(CELLS) + 0.5) / CELLS * 2.0 - 1.0
    A = np.kron(np.eye(2), legendre(place, RIM))
    low = there.copy()
    for _ in range(5):
        c = robust(A[low], top[low])
        off = top - A @ c
        low = there & (off > -max(4.0 * float(np.median(np.abs(off[low]))), HOLE * step))
    corners = np.kron(np.eye(2), legendre(np.array([-1.0, 1.0]), RIM)) @ c
    return float(min(top[low].min(), corners.min()))
