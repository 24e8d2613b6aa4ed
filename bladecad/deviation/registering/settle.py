"""Many poses at once, each let down onto the stand-in of the nominal."""

from __future__ import annotations

import numpy as np

from bladecad.arrays import Array, Mask, Points, Vector
from bladecad.deviation.registering.pose import coordinates, moved, stepped, unit_motions
from bladecad.deviation.registering.stand_in import StandIn

BEYOND = 3.0  # spacings between foot and nearest point, along the surface: past its border
DAMPING = 1.0  # by (width / chord)^2: while it is far, slides that meet no resistance stay short
SIGHT = 6.0  # widths: points further from the blade do not count, and are not looked at
SPREAD = 0.01  # of the chord: what still counts as lying on the blade


def settle(
    stand_in: StandIn, points: Points, T: Array, free: Mask, widths: Vector
) -> tuple[Array, Vector]:
    """Move every pose downhill, one step for every width, and tell how badly it ends.

    Minimises sum_i rho(r_i), rho(r) = r^2 / (c^2 + r^2) (Geman and McClure) of the width c, with
    r the distance to the tangent plane at the nearest point, or to the point itself where that is
    the border: a scan that hangs over is drawn back, and let go as c falls.

    Parameters
    ----------
    stand_in : StandIn
    points : (k, 3) float, mm, in the frame of the scan
    T : (m, 4, 4) float
    free : (6,) bool
        Coordinates that may change, see `motions`.
    widths : (s,) float, mm

    Returns
    -------
    (m, 4, 4) float, (m,) float
        The poses, and the mean of rho at the last width: 0 on the blade, 1 nowhere near it.
    """
    for c in widths:
        Y, r, n, beyond = _met(stand_in, moved(T, points), SIGHT * c)
        M = _metric(r, n, beyond, float(c))
        U, R = unit_motions(T, stand_in.centre, stand_in.reach, free)
        A = _rows(Y - stand_in.centre) @ U[:, None]  # (m, k, 3, f)
        MA = M @ A
        H = np.einsum("mkxi,mkxj->mij", A, MA, optimize=True)
        g = np.einsum("mkxi,mkx->mi", MA, r, optimize=True)
        y = _solved(H, g, DAMPING * (c / stand_in.chord) ** 2)
        T = stepped(T, free, coordinates(R, y))
    return T, badness(stand_in, points, T, float(widths[-1]))


def badness(stand_in: StandIn, points: Points, T: Array, width: float) -> Vector:
    """Mean of rho over the points, for every pose, (m,)."""
    _, r, n, beyond = _met(stand_in, moved(T, points), SIGHT * width)
    along = np.einsum("mkx,mkx->mk", r, n)
    square = np.where(beyond, np.einsum("mkx,mkx->mk", r, r), along**2)
    return np.asarray(np.mean(square / (width**2 + square), axis=1))


def _met(stand_in: StandIn, Y: Array, sight: float) -> tuple[Array, Array, Array, Mask]:
    """Points, the way to them from their nearest point, the normal there, whether past a border.

    The way to points out of sight is set so long that they count as nothing.
    """
    found = stand_in.tree.query(Y.reshape(-1, 3), distance_upper_bound=sight, workers=-1)
    near = np.asarray(found[1]).reshape(Y.shape[:2])
    lost = near == len(stand_in.points)
    near = np.where(lost, 0, near)
    n = stand_in.normals[near]
    r = np.where(lost[..., None], 1e3 * sight, Y - stand_in.points[near])
    aside = r - n * np.einsum("mkx,mkx->mk", r, n)[..., None]
    beyond = np.einsum("mkx,mkx->mk", aside, aside) > (BEYOND * stand_in.spacing) ** 2
    return Y, r, n, beyond


def _metric(r: Array, n: Array, beyond: Mask, c: float) -> Array:
    """Weighted squares of the distance to plane or point, (m, k, 3, 3)."""
    plane = n[..., :, None] * n[..., None, :]
    M = np.where(beyond[..., None, None], np.eye(3), plane)
    square = np.einsum("mkx,mkxy,mky->mk", r, M, r, optimize=True)
    return np.asarray(M * ((c**2 / (c**2 + square)) ** 2)[..., None, None])


def _rows(arm: Array) -> Array:
    """How points move with shift and rotation about the centre, (..., 3, 6)."""
    A = np.zeros((*arm.shape, 6))
    A[..., :3] = np.eye(3)
    A[..., 0, 4], A[..., 0, 5] = arm[..., 2], -arm[..., 1]
    A[..., 1, 3], A[..., 1, 5] = -arm[..., 2], arm[..., 0]
    A[..., 2, 3], A[..., 2, 4] = arm[..., 1], -arm[..., 0]
    return A


def _solved(H: Array, g: Array, damping: float) -> Array:
    """-(H + damping)^-1 g, the damping by the mean of the diagonal."""
    mean = np.einsum("mii->m", H)[:, None, None] / H.shape[1] + 1e-300
    damped = H / mean + damping * np.eye(H.shape[1])
    return np.asarray(-np.linalg.solve(damped, g[..., None] / mean)[..., 0])
