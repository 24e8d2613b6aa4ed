"""What a model makes of a blade, and how far that is from it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, final

import numpy as np

from bladecad.arrays import Array, Lines, Vector
from bladecad.replay.subject import Stretch


@final
@dataclass(frozen=True, eq=False)
class Curves:
    """The curves of one model on one side, at the same parameters as the data.

    at_points : (m, k, 3) float, mm; not finite where a flow leaves the floats
    between   : (m, K, 3) float, mm; where the stretch is judged
    """

    at_points: Lines
    between: Lines


class Score(NamedTuple):
    """Distances at the same parameter over both sides of all sections, mm; inf if one diverges.

    at_points : largest at the points
    largest   : largest on the densified lines
    rms       : there
    median    : of the largest distances, one a line, on the densified lines
    """

    at_points: float
    largest: float
    rms: float
    median: float


def score(stretches: tuple[Stretch, ...], curves: tuple[Curves, ...]) -> Score:
    """Judge the curves of all sides together."""
    pairs = list(zip(stretches, curves, strict=True))
    at = [distance(c.at_points, s.points).max() for s, c in pairs]
    between = [distance(c.between, s.judged.points) for s, c in pairs]
    lines = np.concatenate([d.max(axis=1) for d in between])
    return Score(max(at), lines.max(), _rms(np.concatenate(between, axis=1)), _median(lines))


def distance(curve: Array, points: Array) -> Array:
    """|x(t) - X(t)| at the same t, mm; infinite where x is no number."""
    with np.errstate(over="ignore", invalid="ignore"):
        d = np.sqrt(np.sum((curve - points) ** 2, axis=-1))
    return np.where(np.isfinite(d), d, np.inf)


def _rms(d: Array) -> float:
    largest = d.max()
    return float(largest * np.sqrt(np.mean((d / largest) ** 2))) if np.isfinite(largest) else np.inf


def _median(d: Vector) -> float:
    return float(np.sort(d)[len(d) // 2])
