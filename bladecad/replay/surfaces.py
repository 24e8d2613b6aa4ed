"""The three surfaces of figure 3: the paper's on the core and on whole sides, and the modal one."""

from __future__ import annotations

import numpy as np

from bladecad.arrays import Array, Lines, Vector
from bladecad.replay.curves import distance
from bladecad.replay.results import Results

Surface = tuple[Vector, Lines, Lines]


def three_surfaces(results: Results) -> list[Surface]:
    """Span (n,), surface (n, k, 3) and data lines (m, k, 3) of each, suction side."""
    paper = [(p.u, p.points, results.subjects[r].suction.points) for r, p in results.paper.items()]
    whole, u = results.subjects["full"].suction, results.paper["full"].u
    return [*paper, (u, results.modal["spline"]("suction", u, whole.t), whole.points)]


def away_from_blend(results: Results, u: Vector, S: Lines, data: Lines) -> Array:
    """Distance of a surface from its data blended linearly along the span, (n, k), mm."""
    span = results.subjects["full"].suction.lines.span
    i = np.clip(np.searchsorted(span, u, side="right") - 1, 0, len(span) - 2)
    v = ((u - span[i]) / (span[i + 1] - span[i]))[:, None, None]
    return distance(S, (1 - v) * data[i] + v * data[i + 1])
