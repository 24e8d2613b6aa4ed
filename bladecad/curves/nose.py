"""The radius of a round edge."""

from __future__ import annotations

import numpy as np

from bladecad.arrays import Points
from bladecad.curves.develop import frame
from bladecad.curves.outline import Track

FIRST = 0.01  # of the side: arc of the first circle
ARC = np.radians(60.0)  # either way of the nose
WIDEST = 0.05  # of the side: a nose is smaller
TRIES = 8
DEGREE = 6  # of the nose over that arc: a circle to 1e-4, and what else is round
SAMPLES = np.linspace(0.0, 1.0, 24)


def nose_radius(first: Track, second: Track, at: float) -> float:
    """Return the radius of curvature of a round edge at its nose, mm.

    From the polynomial that fits the outline within 60 degrees on the circle that fits it there:
    on an ellipse or a point the curvature at the nose itself, yet over many points.

    Parameters
    ----------
    first, second : Track
        The two sides, which meet there.
    at : {0.0, 1.0}
        The leading or the trailing edge.
    """
    side = min(first.length, second.length)
    reach = FIRST * side
    for _ in range(TRIES):
        radius = _circle(np.concatenate([_end(track, at, reach) for track in (first, second)]))
        reach = min(ARC * radius, WIDEST * side)
    points = np.concatenate([_end(second, at, reach)[:0:-1], _end(first, at, reach)])
    w = np.concatenate([-SAMPLES[:0:-1], SAMPLES])
    _, x1, x2 = np.polynomial.polynomial.polyfit(w, points - points.mean(axis=0), DEGREE)[:3]
    return float(np.linalg.norm(x1) ** 3 / np.linalg.norm(np.cross(x1, 2.0 * x2)))


def _end(track: Track, at: float, reach: float) -> Points:
    """Points of a side from an edge inwards."""
    return track(np.abs(at - SAMPLES * reach / track.length))


def _circle(points: Points) -> float:
    """Radius of the least-squares circle through points in space: x^2 + y^2 = 2 a x + 2 b y + c."""
    centre, rows, _ = frame(points)
    xy = (points - centre) @ rows[:2].T
    terms = np.column_stack([2.0 * xy, np.ones(len(xy))])
    a, b, c = np.linalg.lstsq(terms, np.sum(xy**2, axis=1), rcond=None)[0]
    return float(np.sqrt(c + a**2 + b**2))
