"""What a blade is cut from: the box, the bar and the ring that hold it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import Final, final

import numpy as np

from bladecad.arrays import Points, Vector, seal
from bladecad.cam.stacking import StackingAxis
from bladecad.data.sections import Machine

ROUNDS: Final = 200  # of the smallest circle


@final
@dataclass(frozen=True, eq=False)
class Stock:
    """The smallest bodies round a blade, without any allowance; mm.

    low, high    : (3,) float, corners of the box along x, y and z
    bar_diameter, bar_length : cylinder along the stacking axis, which it need not have for its own
    ring         : inner and outer radius about the machine axis
    axial        : from and to along the machine axis
    sector       : angle about the machine axis that it takes, radians
    """

    low: Vector
    high: Vector
    bar_diameter: float
    bar_length: float
    ring: tuple[float, float]
    axial: tuple[float, float]
    sector: float

    def __post_init__(self) -> None:
        seal(self, low=(3,), high=(3,))


def stock(points: Points, stacking: StackingAxis, machine: Machine) -> Stock:
    """Bound dense points of a blade.

    Parameters
    ----------
    points : (k, 3) float, mm
    stacking : StackingAxis
        Direction of the bar.
    machine : Machine
        Its axis goes through the origin.
    """
    along = points @ stacking.direction
    flat = points @ np.linalg.svd(stacking.direction[None])[2][1:].T
    c = machine.column
    x, y = points[:, (c + 1) % 3], points[:, (c + 2) % 3]
    r, z = np.hypot(x, y), points[:, c]
    return Stock(
        points.min(axis=0), points.max(axis=0),
        2.0 * _circle(flat), float(np.ptp(along)),
        (float(r.min()), float(r.max())), (float(z.min()), float(z.max())),
        _sector(np.arctan2(y, x)),
    )  # fmt: skip


def _sector(angle: Vector) -> float:
    """The whole turn but for its widest gap."""
    sorted_ = np.sort(angle)
    return float(2.0 * np.pi - np.diff(np.append(sorted_, sorted_[0] + 2.0 * np.pi)).max())


def _circle(points: Points) -> float:
    """Radius of the smallest circle round points in a plane, through two or three of them.

    The furthest point outside joins those that hold the circle, until none is outside: the radius
    grows with every round.
    """
    held = points[[0, int(np.linalg.norm(points - points[0], axis=1).argmax())]]
    for _ in range(ROUNDS):
        held, centre, radius = _held(held)
        away = np.linalg.norm(points - centre, axis=1)
        worst = int(away.argmax())
        if away[worst] <= radius * (1.0 + 1e-12):
            break
        held = np.concatenate([held, points[[worst]]])
    return float(away.max())


def _held(points: Points) -> tuple[Points, Vector, float]:
    """Smallest circle round at most four points: those that hold it, its centre and radius."""
    found = []
    for some in (np.array(c) for k in (2, 3) for c in combinations(points, k)):
        away = some[1:] - some[0]
        centre = some[0] + np.linalg.lstsq(2.0 * away, np.sum(away**2, axis=1), rcond=None)[0]
        found.append((some, centre, float(np.linalg.norm(points - centre, axis=1).max())))
    return min(found, key=lambda circle: circle[2])
