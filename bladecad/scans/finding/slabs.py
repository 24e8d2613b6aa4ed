"""Thin slabs across a direction, and how much the points in each look like a section."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Mask, Points, Vector, seal
from bladecad.scans.finding.runs import Runs

FEWEST: Final = 25  # points of a slab that ten coefficients are found from
DEGREE: Final = 3  # of camber and thickness along the chord
SLENDER: Final = 0.3  # mean thickness over chord; turbines reach 0.2
MISS: Final = 0.35  # of the thickness, rms: points that are no closed, slender loop
LEAN: Final = 0.6  # points of one side more than of the other, over all
STRAY: Final = 0.004  # of the points of a slab may lie beyond the edges
NOTHING: Final = tuple(  # what a slab with too few points looks like
    map(np.asarray, (1.0, 1.0, 9.0, np.zeros(2), np.zeros((2, 2)), 0.0))
)
PROBES: Final = np.linspace(0.025, 0.975, 20)  # over the chord


@final
@dataclass(frozen=True, eq=False)
class Slabs:
    """What the points between neighbouring heights look like.

    In every slab y = c(x) +- sqrt(x (1 - x)) p(x), x over the chord, is fitted, c and p cubic, c
    leaning and turning with the height. What closes to zero at two edges is followed by it; what
    is round, open, solid or a platform is not.

    borders : (m + 1,) float, mm
    count   : (m,) float, points
    chord   : (m,) float, mm
    thick   : (m,) float, mm, mean over the chord
    miss    : (m,) float, rms distance of the points from the loop over that from the camber line
    centre  : (m, 2) float, mm, of the area
    edges   : (m, 2, 2) float, mm, where the chord begins and ends
    quality : (m,) float, 0 for what is no section, 1 for points on a smooth loop
    """

    borders: Vector
    count: Vector
    chord: Vector
    thick: Vector
    miss: Vector
    centre: Array
    edges: Array
    quality: Vector

    def __post_init__(self) -> None:
        m = len(self.count)
        seal(
            self, borders=(m + 1,), count=(m,), chord=(m,), thick=(m,), miss=(m,), centre=(m, 2),
            edges=(m, 2, 2), quality=(m,),
        )  # fmt: skip

    @property
    def heights(self) -> Vector:
        """Middles of the slabs, (m,), mm."""
        return np.asarray(0.5 * (self.borders[1:] + self.borders[:-1]))

    @property
    def area(self) -> Vector:
        """Area of the sections, (m,), mm2."""
        return np.asarray(self.chord * self.thick)


def slabs(flat: Points, borders: Vector) -> Slabs:
    """Cut points into slabs.

    Parameters
    ----------
    flat : (k, 3) float, mm
        Two coordinates across the span, and the height.
    borders : (m + 1,) float, mm
        Rising, evenly spaced.
    """
    m = len(borders) - 1
    place = (flat[:, 2] - borders[0]) / (borders[-1] - borders[0]) * m
    slab = np.where((place >= 0.0) & (place < m), place, m).astype(np.int64)
    n = np.bincount(slab, minlength=m + 1)
    full = np.append(n[:m] >= FEWEST, False)
    ordered = np.argsort(slab, kind="stable")
    ordered = ordered[full[slab[ordered]]]
    found = [np.zeros((m, *of_one.shape)) + of_one for of_one in NOTHING]
    if len(ordered):
        looks = _looks(flat[ordered, :2], 2.0 * (place[ordered] % 1.0) - 1.0, Runs(n[full]))
        for values, there in zip(found, looks, strict=True):
            values[full[:m]] = there
    return Slabs(borders, n[:m].astype(float), *found)


def _looks(flat: Points, lift: Vector, runs: Runs) -> tuple[Array, ...]:
    """Chord, thickness, miss, centre, edges, quality of every slab from its points, (m, ...)."""
    middle = runs.mean(flat)
    X = flat - runs.each(middle)
    rows = np.linalg.eigh(runs.products(X))[1].swapaxes(1, 2)[:, ::-1]
    x, y = np.einsum("kia,ka->ik", runs.each(rows), X)
    low, high = np.array([_ends(part) for part in runs.parts(x)]).T
    chord = np.where(high > low, high - low, 1.0)
    share = np.clip((x - runs.each(low)) / runs.each(chord), 0.0, 1.0)
    cubic = powers(2.0 * share - 1.0, DEGREE)
    camber = np.hstack([cubic, lift[:, None] * cubic[:, :2]])
    nose = np.sqrt(share * (1.0 - share))[:, None] * cubic
    n = camber.shape[1]
    across = y - runs.times(camber, runs.solved(camber, y))
    for _ in range(2):
        c = runs.solved(np.hstack([camber, np.sign(across)[:, None] * nose]), y)
        across = y - runs.times(camber, c[:, :n])
    thickness = 2.0 * np.sqrt(PROBES * (1.0 - PROBES)) * (c[:, n:] @ _AT_PROBES.T)
    thick, largest = thickness.mean(axis=1), np.abs(thickness).max(axis=1)
    off = np.minimum(np.abs(np.abs(across) - runs.times(nose, c[:, n:])), runs.each(largest))
    miss = np.sqrt(runs.mean(off**2) / np.maximum(runs.mean(across**2), 1e-300))
    lean = np.abs(runs.mean(np.sign(across)))
    closed = (high > low) & (thickness.min(axis=1) >= 0.0) & (thick > 0.0)
    quality = np.maximum(0.0, 1.0 - miss / MISS) * np.maximum(0.0, 1.0 - lean / LEAN)
    quality[~closed | (thick >= SLENDER * chord)] = 0.0
    weight = thickness / np.where(closed, thickness.sum(axis=1), 1.0)[:, None]
    curve, ends = (c[:, : DEGREE + 1] @ at.T for at in (_AT_PROBES, _AT_ENDS))
    area = np.stack([low + chord * (weight @ PROBES), (curve * weight).sum(axis=1)], axis=1)
    area[quality == 0.0] = 0.0
    edges = np.stack([np.stack([low, high], axis=1), ends], axis=2)
    return (
        chord, np.abs(thick) + 1e-12, miss, middle + np.einsum("ma,mab->mb", area, rows),
        middle[:, None] + edges @ rows, quality,
    )  # fmt: skip


def _ends(x: Vector) -> tuple[float, float]:
    """Where the chord begins and ends, but for a few points beyond."""
    stray = int(STRAY * len(x))
    ordered = np.partition(x, (stray, len(x) - 1 - stray))
    return float(ordered[stray]), float(ordered[-1 - stray])


def powers(x: Vector, degree: int) -> Array:
    """1, x, .., x^degree, (k, degree + 1)."""
    return np.vander(x, degree + 1, increasing=True)


_AT_PROBES: Final = powers(2.0 * PROBES - 1.0, DEGREE)
_AT_ENDS: Final = powers(np.array([-1.0, 1.0]), DEGREE)


def longest_run(links: Mask, weight: Vector) -> tuple[int, int]:
    """First and last number of the neighbours joined by links, (m - 1,), that weigh most."""
    breaks = np.concatenate([[-1], np.flatnonzero(~links), [len(links)]])
    run = np.concatenate([[0.0], np.cumsum(weight)])
    sums = run[breaks[1:] + 1] - run[breaks[:-1] + 1]
    best = int(sums.argmax())
    return int(breaks[best]) + 1, int(breaks[best + 1])


def alike(found: Slabs, chord: float, area: float) -> NDArray[np.bool_]:
    """Which slabs are sections, and followed by one much like them, (m - 1,)."""
    good = found.quality > 0.0
    dc, da = np.abs(np.diff(np.log(found.chord))), np.abs(np.diff(np.log(found.area)))
    return np.asarray(good[1:] & good[:-1] & (dc < chord) & (da < area))
