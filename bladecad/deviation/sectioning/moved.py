"""How the outline of a section moves with the deviation fitted to it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Mask, Vector, seal
from bladecad.deviation.sectioning.station import SAMPLES, Station
from bladecad.deviation.sectioning.trend import Trend

SQUARE: Final = (
    0.3  # sine between side and face of a cut-off edge: flatter, the corner is no corner
)


@final
@dataclass(frozen=True, eq=False)
class Movement:
    """Outlines of a section, linear in the coefficients of its deviation.

    start : (n, 2) float, mm, the nominal outline in the flat
    by    : (n, 2, q) float, how every point moves with every coefficient
    gaps  : (n, 2, g) float, how it would move by 1 mm at the middle of every stretch without points
    """

    start: Array
    by: Array
    gaps: Array

    def __post_init__(self) -> None:
        seal(self, start=(None, 2), by=(len(self.start), 2, None))
        seal(self, gaps=(len(self.start), 2, None))

    def outlines(self, c: Vector, step: float) -> Array:
        """Nominal, actual, and actual with each coefficient, then each gap, a step larger."""
        actual = self.start + self.by @ c
        changed = np.concatenate([self.by, self.gaps], axis=2) * step
        return np.concatenate([[self.start, actual], actual + np.moveaxis(changed, 2, 0)])


def movement(station: Station, trend: Trend) -> Movement:
    """Tell how the outline moves: along its normal, as far as the skin leans more."""
    rows = trend.rows
    out = station.stretch[:, None] * station.flat_normal
    by = out[:, :, None] * rows[:, None]
    gaps = out[:, :, None] * _bumps(station, trend.measured)[:, None]
    q = rows.shape[1]
    if station.le == "blunt":
        _move_corners(station, by, (len(by) - 1, 0), q - 2)
    if station.te == "blunt":
        _move_corners(station, by, (SAMPLES - 1, SAMPLES), q - 1)
    return Movement(station.flat, by, gaps)


def _move_corners(station: Station, by: Array, corners: tuple[int, int], face: int) -> None:
    """Corners of a cut-off edge: where the moved side meets the moved face."""
    a, b = station.flat[list(corners)]
    across = (b - a) / np.linalg.norm(b - a)
    inside = station.flat.mean(axis=0) - 0.5 * (a + b)
    n_face = np.array([across[1], -across[0]])
    n_face = -n_face if n_face @ inside > 0 else n_face
    for k in corners:
        N = np.stack([station.flat_normal[k], n_face])
        if abs(np.linalg.det(N)) < SQUARE:
            continue
        d = np.stack([station.flat_normal[k] @ by[k], np.zeros(by.shape[2])])
        d[1, face] = 1.0 / station.scale[k]
        by[k] = np.linalg.solve(N, d)


def _bumps(station: Station, measured: Mask) -> Array:
    """One smooth bump over every stretch of the loop without points, (n, g)."""
    runs = _runs(~measured)
    bumps = np.zeros((len(measured), len(runs)))
    for g, run in enumerate(runs):
        arc = np.unwrap(station.arc[run], period=station.perimeter)
        length = arc[-1] - arc[0]
        x = (arc - arc[0]) / length if length > 0 else np.full(len(run), 0.5)
        bumps[run, g] = np.sin(np.pi * x) ** 2
    return bumps


def _runs(which: Mask) -> list[NDArray[np.intp]]:
    """Numbers of neighbours round the loop that all are so."""
    n = len(which)
    if which.all():
        return [np.arange(n)]
    first = int(np.argmin(which))
    order = (first + np.arange(n)) % n
    found = np.split(order, np.flatnonzero(np.diff(which[order])) + 1)
    return [run for run in found if which[run[0]]]
