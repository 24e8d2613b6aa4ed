"""Starting poses, and the one of them from which the scan falls into place."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from bladecad.arrays import Array, Mask, Points, Vector, seal
from bladecad.deviation.registering.pose import pose
from bladecad.deviation.registering.settle import SPREAD, badness, settle
from bladecad.deviation.registering.stand_in import StandIn, thinned

FLIPS = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]], float)
TURNS = 12  # about the thin axis
RANDOM = 200  # orientations besides
ELSEWHERE = 0.35  # norm of a difference of rotations: about 15 degrees
HARDLY = 0.05  # worse
GOOD = 0.1  # badness at which no other start is tried: nearly all points lie on the blade


@final
@dataclass(frozen=True, eq=False)
class Start:
    """A pose near the blade.

    T       : (4, 4) float
    badness : 0 where all points lie on the blade, 1 where none does
    others  : (m, 4, 4) float, poses turned to elsewhere that are hardly worse
    tried   : poses tried
    """

    T: Array
    badness: float
    others: Array
    tried: int

    def __post_init__(self) -> None:
        seal(self, T=(4, 4), others=(None, 4, 4))


def find_start(stand_in: StandIn, points: Points, free: Mask) -> Start:
    """Try the pose as given and the four that lay principal axes on each other; then many more.

    The others are for scans of a part of the blade, whose principal axes are not those of the
    blade: turned about the thin axis, shifted along both long ones, and turned at random. Most are
    dropped after a few steps on a few points.

    Parameters
    ----------
    stand_in : StandIn
    points : (k, 3) float, mm, at random from the scan, some thousands
    free : (6,) bool
    """
    sample = thinned(points)
    few = _some(sample, 400)
    if not free.all():
        return _race(stand_in, sample, _limited(stand_in, sample, free), free, ((200, 25, 12),))
    first = np.concatenate([[np.eye(4)], _by_axes(stand_in, sample, FLIPS)])
    widths = _falling(stand_in, 24)
    T, _ = settle(stand_in, few, first, free, widths)
    found = _best(stand_in, sample, T, len(first))
    if found.badness < GOOD:
        return found
    many = np.concatenate([first, _turned(stand_in, sample), _random(stand_in, sample)])
    rounds = ((60, 6, 120), (150, 8, 25), (400, 20, 6))
    other = _race(stand_in, sample, many, free, rounds)
    return other if other.badness < found.badness else found


def _race(
    stand_in: StandIn,
    sample: Points,
    T: Array,
    free: Mask,
    rounds: tuple[tuple[int, int, int], ...],
) -> Start:
    """Rounds of (points, steps, how many stay)."""
    tried, coarse = len(T), stand_in.every(10)
    for count, steps, stay in rounds:
        few = _some(sample, count)
        T, bad = settle(coarse, few, T, free, np.full(steps, 0.1 * stand_in.chord))
        T = T[np.argsort(bad, kind="stable")[:stay]]
    T, _ = settle(stand_in, _some(sample, 1000), T, free, _falling(stand_in, 18))
    return _best(stand_in, sample, T, tried)


def _best(stand_in: StandIn, sample: Points, T: Array, tried: int) -> Start:
    """The pose of least badness; on a tie the one that came first."""
    bad = badness(stand_in, sample, T, SPREAD * stand_in.chord)
    k = int(np.argmin(np.round(bad, 6)))
    apart = np.linalg.norm((T - T[k])[:, :3, :3], axis=(1, 2)) > ELSEWHERE
    others = T[apart & (bad < bad[k] + HARDLY)]
    return Start(T[k], float(bad[k]), others[:2], tried)


def _falling(stand_in: StandIn, steps: int) -> Vector:
    """Widths from a fifth of the chord down to what counts as lying on it, and some there."""
    falling = np.geomspace(0.2, SPREAD, steps)
    return np.asarray(np.concatenate([falling, np.full(steps // 3, SPREAD)]) * stand_in.chord)


def _some(points: Points, count: int) -> Points:
    drawn = np.linspace(0, len(points) - 1, min(count, len(points)))
    return np.asarray(points[drawn.astype(int)])


def _axes(points: Points) -> tuple[Vector, Array]:
    """Centre, and principal axes as rows of a rotation, the longest first."""
    centre = points.mean(axis=0)
    V = np.linalg.svd(points - centre, full_matrices=False)[2]
    V[2] *= np.sign(np.linalg.det(V))
    return centre, V


def _laid(stand_in: StandIn, sample: Points, turns: Array, shifts: Array) -> Array:
    """Poses that bring centre to centre + shift, and axes to turned axes, (turns x shifts)."""
    a, V = _axes(sample)
    b, W = _axes(stand_in.points)
    R = np.repeat(W.T @ turns @ V, len(shifts), axis=0)
    to = b + np.tile(shifts @ W, (len(turns), 1))
    return pose(R, to - R @ a)


def _by_axes(stand_in: StandIn, sample: Points, flips: Array) -> Array:
    return _laid(stand_in, sample, np.array([np.diag(f) for f in flips]), np.zeros((1, 3)))


def _turned(stand_in: StandIn, sample: Points) -> Array:
    """Turned about the thin axis, either side up, and shifted along the long ones."""
    angles = 2.0 * np.pi * np.arange(TURNS) / TURNS
    about = Rotation.from_rotvec(np.outer(angles, [0.0, 0.0, 1.0])).as_matrix()
    turns = np.concatenate([about, about @ np.diag([1.0, -1.0, -1.0])])
    return _laid(stand_in, sample, turns, _shifts(stand_in, sample))


def _random(stand_in: StandIn, sample: Points) -> Array:
    turns = Rotation.from_quat(np.random.default_rng(5).normal(size=(RANDOM, 4))).as_matrix()
    return _laid(stand_in, sample, turns, np.zeros((1, 3)))


def _shifts(stand_in: StandIn, sample: Points) -> Array:
    """Nine shifts over the room that a smaller, or larger, cloud leaves along the long axes."""
    size = [np.ptp((p - c) @ V.T, axis=0)
            for p in (sample, stand_in.points) for c, V in (_axes(p),)]  # fmt: skip
    room = 0.35 * np.abs(size[1] - size[0])
    return np.array([[i * room[0], j * room[1], 0.0] for i, j in product((0, -1, 1), repeat=2)])


def _limited(stand_in: StandIn, sample: Points, free: Mask) -> Array:
    """As given, and centres brought together and turned as far as the free coordinates allow."""
    turns: list[NDArray[np.float64]] = [np.zeros(3)]
    for axis in np.flatnonzero(free[3:]):
        turns += [a * np.eye(3)[axis] for a in 2.0 * np.pi * np.arange(1, TURNS) / TURNS]
    R = Rotation.from_rotvec(np.array(turns)).as_matrix()
    p = np.where(free[:3], stand_in.centre - R @ sample.mean(axis=0), 0.0)
    return np.concatenate([[np.eye(4)], pose(R, p)])
