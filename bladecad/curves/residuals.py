"""How far each point of a section lies from where its neighbours would put it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Points, Vector, seal
from bladecad.curves.corners import corners
from bladecad.curves.develop import Flat
from bladecad.data.sections import Section

Indices = NDArray[np.intp]
Mask = NDArray[np.bool_]
Stretches = tuple[list[Indices], bool]  # point numbers in loop order; if they are one ring
NEIGHBOURS = 4  # of the cubic that predicts a point
FEWEST = 8  # points of a run that can judge one another
AROUND = np.array([-8, -7, -6, -5, -4, -3, 3, 4, 5, 6, 7, 8])  # nearby, but not of the same cubic
TINY = 1e-300  # no direction where a line turns back on itself
MAD = 1.4826  # standard deviation over median absolute deviation


@final
@dataclass(frozen=True, eq=False)
class Residuals:
    """Each point against the cubic through its two kept neighbours on either side.

    away   : (n,) float, mm; distance from the cubic, 0 where too few neighbours can judge
    offset : (n,) float, mm; the part across the outline, positive to the left of the loop
    gain   : (n,) float; standard deviation of `offset` for points of noise 1
    usual  : (n,) float, mm; robust scale of `away` nearby
    """

    away: Vector
    offset: Vector
    gain: Vector
    usual: Vector

    def __post_init__(self) -> None:
        n = len(self.away)
        seal(self, away=(n,), offset=(n,), gain=(n,), usual=(n,))

    @property
    def rough(self) -> Vector:
        """(n,) float: `away` in units of point noise, comparable from point to point."""
        return self.away / self.gain


def runs(section: Section, flat: Flat) -> Stretches:
    """Return the smooth stretches of a loop, from corner to corner."""
    n = len(section.points)
    told = [edge for edge in (section.le, section.te) if len(edge) == 2]
    shown = corners(flat.points) + corners(flat.points * [1.0, -1.0])
    breaks = sorted({(edge[0], edge[-1]) for edge in told + shown})
    if not section.closed and not any(last == n - 1 or first == 0 for last, first in breaks):
        breaks.append((n - 1, 0))
    if not breaks:
        return [np.arange(n)], True
    ends = zip(breaks, breaks[1:] + breaks[:1], strict=True)
    return [_from_to(first, last, n) for (_, first), (last, _) in ends], False


def residuals(section: Section, flat: Flat, stretches: Stretches, keep: Mask) -> Residuals:
    """Judge the kept points of a section by one another."""
    all_runs, ring = stretches
    n = len(section.points)
    away, offset, gain, usual = np.zeros(n), np.zeros(n), np.ones(n), np.zeros(n)
    for run in all_runs:
        kept = run[keep[run]]
        if len(kept) >= FEWEST:
            found = _judged(section.points[kept], flat, kept, ring)
            away[kept], offset[kept], gain[kept], usual[kept] = found
    return Residuals(away, offset, gain, usual)


def lagrange(nodes: Array, x: Vector) -> Array:
    """Return the weights (n, k) with which values at `nodes` (n, k) give the value at `x` (n,)."""
    k = nodes.shape[1]
    own = np.eye(k, dtype=bool)
    below = np.where(own, 1.0, nodes[:, :, None] - nodes[:, None, :])
    above = np.where(own, 1.0, (x[:, None] - nodes)[:, None, :])
    return np.asarray((above / below).prod(axis=2))


def windows(n: int, k: int, ring: bool) -> Indices:
    """Return for each of n places the k nearest others, (n, k); a ring goes on beyond n."""
    i = np.arange(n)[:, None]
    first = i - k // 2 if ring else np.clip(i - k // 2, 0, n - k - 1)
    around = first + np.arange(k + 1)
    others: Indices = around[around != i].reshape(n, k)
    return others


def _from_to(first: int, last: int, n: int) -> Indices:
    count = (last - first) % n or n
    return (first + np.arange(count + 1)) % n


def _judged(points: Points, flat: Flat, index: Indices, ring: bool) -> tuple[Vector, ...]:
    n = len(points)
    steps = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    s, length = np.concatenate([[0.0], np.cumsum(steps[:-1])]), float(steps.sum())
    others = windows(n, NEIGHBOURS, ring)
    weights = lagrange(s[others % n] + length * (others // n), s)
    gain = np.sqrt(1.0 + np.sum(weights**2, axis=1))
    away = np.linalg.norm(_across(points, weights, others % n, ring), axis=1)
    x, y = _across(flat.points[index], weights, others % n, ring).T
    tx, ty = _tangents(flat.points[index], ring).T
    offset = (tx * y - ty * x) * flat.scale[index]
    near = np.arange(n)[:, None] + AROUND
    near = near % n if ring else np.clip(near, 0, n - 1)
    usual = MAD * np.median((away / gain)[near], axis=1) * gain
    return away, offset, gain, usual


def _across(points: Array, weights: Array, others: Indices, ring: bool) -> Array:
    """Points less their prediction, without the part along the outline."""
    miss = points - np.einsum("nk,nkd->nd", weights, points[others])
    T = _tangents(points, ring)
    return np.asarray(miss - T * np.einsum("nd,nd->n", miss, T)[:, None])


def _tangents(points: Array, ring: bool) -> Array:
    T = np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0)
    if not ring:
        T[0], T[-1] = points[1] - points[0], points[-1] - points[-2]
    return np.asarray(T / np.maximum(np.linalg.norm(T, axis=1), TINY)[:, None])
