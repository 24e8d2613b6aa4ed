"""Thin slabs across a direction, and how much the points in each look like a section."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Mask, Points, Vector, seal

FEWEST: Final = 25  # points of a slab that ten coefficients are found from
DEGREE: Final = 3  # of camber and thickness along the chord
SLENDER: Final = 0.3  # mean thickness over chord; turbines reach 0.2
MISS: Final = 0.35  # of the thickness, rms: points that are no closed, slender loop
LEAN: Final = 0.6  # points of one side more than of the other, over all
STRAY: Final = 0.004  # of the points of a slab may lie beyond the edges
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
    inside = (place >= 0.0) & (place < m)
    flat, place = flat[inside], place[inside]
    slab = place.astype(np.int64)
    order = np.argsort(slab, kind="stable")
    flat, slab, place = flat[order], slab[order], place[order]
    n = np.bincount(slab, minlength=m)
    ends = np.cumsum(n)
    found = [
        _slab(flat[e - k : e], 2.0 * (place[e - k : e] % 1.0) - 1.0)
        for e, k in zip(ends, n, strict=True)
    ]
    chord, thick, miss, quality = np.array([f[0] for f in found]).reshape(m, 4).T
    centre = np.array([f[1] for f in found]).reshape(m, 2)
    edges = np.array([f[2] for f in found]).reshape(m, 2, 2)
    return Slabs(borders, n.astype(float), chord, thick, miss, centre, edges, quality)


Found = tuple[tuple[float, float, float, float], Vector, Array]
NOTHING: Final[Found] = ((1.0, 1.0, 9.0, 0.0), np.zeros(2), np.zeros((2, 2)))


def _slab(flat: Points, lift: Vector) -> Found:
    """Chord, thickness, miss and quality of one slab; its centre; its two edges."""
    if len(flat) < FEWEST:
        return NOTHING
    middle = flat[:, :2].mean(axis=0)
    X = flat[:, :2] - middle
    rows = np.linalg.eigh(X.T @ X)[1].T[::-1]
    x, y = rows @ X.T
    stray = int(STRAY * len(x))
    ordered = np.partition(x, (stray, len(x) - 1 - stray))
    low, high = float(ordered[stray]), float(ordered[-1 - stray])
    if high - low <= 0.0:
        return NOTHING
    share = np.clip((x - low) / (high - low), 0.0, 1.0)
    cubic = powers(2.0 * share - 1.0, DEGREE)
    camber = np.hstack([cubic, lift[:, None] * cubic[:, :2]])
    across = y - camber @ _solved(camber, y)
    nose = np.sqrt(share * (1.0 - share))[:, None] * cubic
    for _ in range(2):
        both = np.hstack([camber, np.sign(across)[:, None] * nose])
        c = _solved(both, y)
        across = y - camber @ c[: camber.shape[1]]
    half = nose @ c[camber.shape[1] :]
    thickness = 2.0 * np.sqrt(PROBES * (1.0 - PROBES)) * (_AT_PROBES @ c[camber.shape[1] :])
    thick, chord = float(thickness.mean()), high - low
    largest = float(np.abs(thickness).max())
    off = np.minimum(np.abs(np.abs(across) - half), largest)
    miss = float(np.sqrt(np.mean(off**2) / max(np.mean(across**2), 1e-300)))
    lean = abs(float(np.sign(across).mean()))
    if thickness.min() < 0.0 or not 0.0 < thick < SLENDER * chord:
        quality = 0.0
    else:
        quality = max(0.0, 1.0 - miss / MISS) * max(0.0, 1.0 - lean / LEAN)
    at = low + chord * float(np.sum(PROBES * thickness) / max(np.sum(thickness), 1e-300))
    curve = _AT_PROBES @ c[: DEGREE + 1]
    up = float(np.sum(curve * thickness) / max(np.sum(thickness), 1e-300))
    ends = powers(np.array([-1.0, 1.0]), DEGREE) @ c[: DEGREE + 1]
    edges = np.stack([middle + rows.T @ np.array(e) for e in ((low, ends[0]), (high, ends[1]))])
    centre = middle + rows.T @ np.array([at, up]) if quality > 0.0 else middle
    return (chord, abs(thick) + 1e-12, miss, quality), centre, edges


def powers(x: Vector, degree: int) -> Array:
    """1, x, .., x^degree, (k, degree + 1)."""
    return np.asarray(x[:, None] ** np.arange(degree + 1))


_AT_PROBES: Final = powers(2.0 * PROBES - 1.0, DEGREE)


def _solved(A: Array, y: Vector) -> Vector:
    G = A.T @ A
    G[np.diag_indices_from(G)] += 1e-9 * np.trace(G) / len(G)
    return np.asarray(np.linalg.solve(G, A.T @ y))


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
