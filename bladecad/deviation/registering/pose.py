"""Rigid motions: where a body stands, and the small steps that its free directions allow."""

from __future__ import annotations

from typing import Final, Literal, get_args

import numpy as np
from scipy.spatial.transform import Rotation

from bladecad.arrays import Array, Mask, Points, Vector

Freedom = Literal["x", "y", "z", "rx", "ry", "rz"]
FREEDOMS: Final[tuple[Freedom, ...]] = get_args(Freedom)


def pose(R: Array, p: Array) -> Array:
    """T of x -> R x + p, (..., 4, 4)."""
    T = np.zeros((*R.shape[:-2], 4, 4))
    T[..., :3, :3], T[..., :3, 3], T[..., 3, 3] = R, p, 1.0
    return T


def moved(T: Array, points: Points) -> Array:
    """The points where T puts them, (..., k, 3)."""
    return np.asarray(points @ np.swapaxes(T[..., :3, :3], -1, -2) + T[..., None, :3, 3])


def cross_matrix(a: Array) -> Array:
    """[a]x, the matrix of b -> a x b, (..., 3, 3)."""
    K = np.zeros((*a.shape, 3))
    K[..., 2, 1], K[..., 0, 2], K[..., 1, 0] = a[..., 0], a[..., 1], a[..., 2]
    return K - np.swapaxes(K, -1, -2)


def motions(T: Array, centre: Vector, free: Mask) -> Array:
    """How a body at T moves about `centre` as its free coordinates change, (..., 6, f).

    The coordinates of T are its shift p and its rotation vector w, in the axes of the nominal's
    frame and about its origin. Column j holds shift of the body at `centre` and rotation, both per
    unit of free coordinate j:  rotation = J(w) dw,  shift = dp + rotation x (centre - p), with
    J(w) = 1 + (1 - cos a)/a^2 [w]x + (a - sin a)/a^3 [w]x^2, a = |w|
    (Barfoot, State Estimation for Robotics, section 7.1.5).
    """
    w = Rotation.from_matrix(T[..., :3, :3]).as_rotvec()
    a = np.maximum(np.linalg.norm(w, axis=-1), 1e-6)[..., None, None]
    K = cross_matrix(w)
    J = np.eye(3) + (1.0 - np.cos(a)) / a**2 * K + (a - np.sin(a)) / a**3 * (K @ K)
    B = np.zeros((*T.shape[:-2], 6, 6))
    B[..., :3, :3] = np.eye(3)
    B[..., :3, 3:] = -cross_matrix(centre - T[..., :3, 3]) @ J
    B[..., 3:, 3:] = J
    return np.asarray(B[..., free])


def unit_motions(T: Array, centre: Vector, reach: float, free: Mask) -> tuple[Array, Array]:
    """The free motions, each of 1 mm and square to the others, and coordinates that bring them.

    A radian is worth `reach` mm. The columns of U, (..., 6, f), are shift (mm) at the centre and
    rotation (rad); R, (..., f, f), is for `coordinates`.
    """
    worth = np.repeat([1.0, reach], 3)[:, None]
    Q, R = np.linalg.qr(worth * motions(T, centre, free))
    return np.asarray(Q / worth), np.asarray(R)


def coordinates(R: Array, y: Array) -> Array:
    """The step of the free coordinates, (..., f), that is the motion U y."""
    return np.asarray(np.linalg.solve(R, y[..., None])[..., 0], dtype=np.float64)


def stepped(T: Array, free: Mask, step: Array) -> Array:
    """T with its free coordinates changed by `step`, (..., f)."""
    full = np.zeros((*T.shape[:-2], 6))
    full[..., free] = step
    w = Rotation.from_matrix(T[..., :3, :3]).as_rotvec() + full[..., 3:]
    return pose(Rotation.from_rotvec(w).as_matrix(), T[..., :3, 3] + full[..., :3])


def free_of(locked: tuple[Freedom, ...]) -> Mask:
    """Which of the six coordinates may change."""
    return np.array([name not in locked for name in FREEDOMS])
