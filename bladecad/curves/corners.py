"""Corners of a loop: where a cut-off or a sharp edge breaks the smooth outline."""

from __future__ import annotations

import numpy as np

from bladecad.arrays import Points, Vector

BLUNT_TURN = np.radians(50.0)  # a corner of a cut-off edge turns by about 90 degrees
SHARP_TURN = np.radians(100.0)  # a wedge turns by nearly 180 degrees at one point
SMOOTH_TURN = np.radians(18.0)  # the outline beside a corner, and the face between two, is straight
WIDEST_FACE = 12  # points on the face of a cut-off edge


def corners(loop: Points) -> list[tuple[int, ...]]:
    """Find the edges of a closed loop that are not round.

    Parameters
    ----------
    loop : (n, 2) float
        Flat, counter-clockwise, the first point not repeated.

    Returns
    -------
    list
        ``(i,)`` for a sharp edge at point i, ``(i, j)`` for a cut-off edge whose face runs in loop
        order from point i to point j. A round edge spreads its turn over several points.
    """
    turn = turns(loop)
    found: list[tuple[int, ...]] = [(int(i),) for i in np.flatnonzero(turn > SHARP_TURN)]
    strong = np.flatnonzero((turn > BLUNT_TURN) & (turn <= SHARP_TURN + BLUNT_TURN / 2))
    n = len(loop)
    for i in strong:
        for j in strong:
            width = (j - i) % n
            if 1 <= width <= WIDEST_FACE and turn[i] + turn[j] > 2.2 * BLUNT_TURN:
                found.append((int(i), int(j)))
    return [edge for edge in found if _stands_alone(turn, edge)]


def turns(loop: Points) -> Vector:
    """Return the exterior angle at each point of a closed flat loop, (n,), radians."""
    d = np.roll(loop, -1, axis=0) - loop
    before = np.roll(d, 1, axis=0)
    cross = before[:, 0] * d[:, 1] - before[:, 1] * d[:, 0]
    return np.asarray(np.arctan2(cross, np.einsum("kd,kd->k", before, d)))


def _stands_alone(turn: Vector, edge: tuple[int, ...]) -> bool:
    """Whether the outline runs straight into the corners, and between them."""
    n, i, j = len(turn), edge[0], edge[-1]
    beside = np.array([i - 2, i - 1, *range(i + 1, i + (j - i) % n), j + 1, j + 2]) % n
    return bool(np.abs(turn[beside]).max() < SMOOTH_TURN)
