"""The stacking axis of a scan, whatever its pose and whatever hangs on to the airfoil."""

from __future__ import annotations

from typing import Final

import numpy as np

from bladecad.arrays import Points, Vector
from bladecad.scans.finding.height import planes
from bladecad.scans.finding.slabs import Slabs, alike, longest_run, slabs

DIRECTIONS: Final = 120  # over the half sphere: none is more than 10 degrees away
FEW: Final = 5_000  # points on which all of them are tried
MANY: Final = 24_000  # on which the best are refined
STARTS: Final = 4
COARSE: Final = 20  # slabs over the whole scan
FINE: Final = 40
ASTRAY: Final = 8  # power of the cosine between the centres and a direction they leave
APART: Final = np.cos(np.radians(20.0))  # starts are further from each other
CHANGES: Final = (0.12, 0.25)  # of ln chord and ln area from slab to slab
STEADY: Final = 0.04  # change of ln chord that halves the worth of a slab
ROUNDS: Final = 5
KEPT: Final = 0.8  # of its worth: a direction that loses more has gone astray
STILL: Final = 1e-6  # less 1, cosine of the last turn: 0.08 degrees


def stacking_axis(points: Points) -> tuple[Vector, float]:
    """Find the direction across which most points lie on slender closed loops that change slowly.

    Returns
    -------
    axis : (3,) float
        Unit; which end is the hub is not said.
    worth : float
        Share of the points on such loops, times how well these are followed; 0: none.
    """
    thin = points[:: max(len(points) // FEW, 1)][:FEW]
    tried = _half_sphere(DIRECTIONS)
    worths = np.array([_worth(_cut(thin, a, COARSE), len(thin)) for a in tried])
    best, most = tried[0], 0.0
    for start in _starts(tried, worths):
        axis, worth = _refined(points[:MANY], start)
        if worth > most:
            best, most = axis, worth
    return best, most


def _starts(tried: Points, worths: Vector) -> list[Vector]:
    """The best directions that lie apart from each other."""
    chosen: list[Vector] = []
    for k in np.argsort(-worths, kind="stable"):
        if worths[k] > 0.0 and all(abs(tried[k] @ c) < APART for c in chosen):
            chosen.append(tried[k])
        if len(chosen) == STARTS:
            break
    return chosen


def _refined(points: Points, axis: Vector) -> tuple[Vector, float]:
    """Turn a direction to the line through the centres of the sections, until it stays."""
    found = _cut(points, axis, FINE)
    worth, along = _worth(found, len(points)), 0.0
    for _ in range(ROUNDS):
        line = _line(found, axis)
        along = abs(float(line @ axis)) if line is not None else 0.0
        if line is None or 1.0 - along < STILL:
            break
        new = _cut(points, line, FINE)
        if _worth(new, len(points)) < KEPT * worth:
            break
        axis, found, worth = line, new, _worth(new, len(points))
    return axis, worth * along**ASTRAY


def _line(found: Slabs, axis: Vector) -> Vector | None:
    """Direction of the line through the centres of the run, robust; None where it is short."""
    first, last = longest_run(alike(found, *CHANGES), _worths(found))
    if last - first < 3:
        return None
    run = slice(first, last + 1)
    h, q = found.heights[run], found.quality[run] * found.count[run]
    x = h - np.average(h, weights=q)
    weight = q.copy()
    for _ in range(5):
        A = np.stack([np.ones_like(x), x], axis=1)
        fit = np.linalg.lstsq(
            A * np.sqrt(weight)[:, None], found.centre[run] * np.sqrt(weight)[:, None]
        )[0]
        off = np.linalg.norm(found.centre[run] - A @ fit, axis=1)
        weight = q / (1.0 + (off / max(2.0 * float(np.median(off)), 1e-12)) ** 2)
    frame = planes(axis)
    turned = frame.round(np.append(fit[1], 1.0)[None], 0.0, 0.0)[0]
    return np.asarray(turned / np.linalg.norm(turned))


def _worths(found: Slabs) -> Vector:
    """Worth of each slab: its points, how well they are followed, how little the chord changes."""
    change = np.diff(np.log(found.chord)) / STEADY
    steady = 1.0 / (1.0 + np.maximum(np.append(change, 0.0) ** 2, np.append(0.0, change) ** 2))
    return np.asarray(found.quality * found.count * steady)


def _worth(found: Slabs, count: int) -> float:
    worths = _worths(found)
    first, last = longest_run(alike(found, *CHANGES), worths)
    return float(worths[first : last + 1].sum()) / count if last > first else 0.0


def _cut(points: Points, axis: Vector, count: int) -> Slabs:
    flat = planes(axis).flat(points, 0.0, 0.0)
    low, high = np.quantile(flat[:, 2], (0.002, 0.998))
    return slabs(flat, np.linspace(low, high, count + 1))


def _half_sphere(count: int) -> Points:
    """Directions spread evenly, no two opposite."""
    k = np.arange(count) + 0.5
    z, turn = 1.0 - k / count, np.pi * (1.0 + np.sqrt(5.0)) * k
    r = np.sqrt(1.0 - z * z)
    return np.stack([r * np.cos(turn), r * np.sin(turn), z], axis=1)
