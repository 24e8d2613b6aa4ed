"""A loop laid anew through points, by their distances from the loop they lie about."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.spatial import cKDTree

from bladecad.arrays import Array, Points, Vector
from bladecad.scans.slicing.capsule import graded
from bladecad.scans.slicing.smooth import periodic, smooth

DENSE: Final = 1920  # points of a loop between which it is straight
FAR: Final = 0.06  # of the length of the loop: points beyond are none of it

REST: Final = 0.25  # of the noise, rms, that a loop may be moved by to be smoother
STIFFER: Final = (1e-4, 1e-3, 1e-2, 1e-1, 1.0, 10.0)

Tips = tuple[tuple[Vector, float], tuple[Vector, float]]


def renewed(
    loop: Points, tips: Tips, q: Points, lift: Vector, noise: float, stiff: float
) -> tuple[Points, float]:
    """Move a loop along its normals to where the points are, smoothly.

    Parameters
    ----------
    loop : (DENSE, 2) float, mm
        Counter-clockwise or not; first point not repeated.
    tips : two pairs of place and radius, mm
        The edges.
    q, lift : (k, 2) and (k,) float
        Points, and their height over the section.
    noise, stiff : float
        Of the points, mm; least weight of smoothness.

    Returns
    -------
    loop, noise
        The loop, moved, and what the points stand off it, mm.
    """
    run = _run(loop)
    places = tuple(float(run[_nearest(loop, tip)]) for tip, _ in tips)
    radii = tips[0][1], tips[1][1]
    x, number = graded(float(run[-1]), (places[0], places[1]), radii, 4 * DENSE)
    count = int(np.clip(number[-1], 60, 200))
    w = np.interp(run[:-1], x, number) / number[-1]
    c = _laid(loop, w, count, REST * noise)
    even = np.arange(DENSE) / DENSE
    base = periodic(even, count) @ c
    T = np.roll(base, -1, axis=0) - np.roll(base, 1, axis=0)
    normal = np.stack([T[:, 1], -T[:, 0]], axis=1)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    at, off = _feet(base, normal, q)
    near = np.abs(off) < FAR * run[-1]
    f = smooth(at[near], lift[near], off[near], count, stiff)
    return np.asarray(base + f(even)[:, None] * normal), f.noise


def _laid(loop: Points, w: Vector, count: int, rest: float) -> Array:
    """Coefficients of the smoothest line that a loop stays near, (count, 2)."""
    B = periodic(w, count)
    G, r = (B.T @ B).toarray(), np.asarray(B.T @ loop)
    D = np.roll(np.eye(count), -1, axis=0) - np.eye(count)
    P = np.trace(G) / count * np.linalg.matrix_power(D, 3).T @ np.linalg.matrix_power(D, 3)
    c = np.linalg.solve(G + STIFFER[0] * P, r)
    for weight in STIFFER[1:]:
        new = np.linalg.solve(G + weight * P, r)
        if np.sqrt(np.mean(np.sum((loop - B @ new) ** 2, axis=1))) > rest:
            break
        c = new
    return np.asarray(c)


def _feet(base: Points, normal: Points, q: Points) -> tuple[Vector, Vector]:
    """Where on the loop the feet of points are, 0 .. 1, and the distances, outwards or not."""
    _, near = cKDTree(base).query(q)
    d = q - base[near]
    off = np.einsum("kx,kx->k", d, normal[near])
    tangent = np.stack([-normal[near, 1], normal[near, 0]], axis=1)
    along = np.einsum("kx,kx->k", d, tangent)
    step = 0.5 * (
        np.linalg.norm(base[(near + 1) % len(base)] - base[near], axis=1)
        + np.linalg.norm(base[near] - base[near - 1], axis=1)
    )
    return np.mod((near + np.clip(along / step, -0.5, 0.5)) / len(base), 1.0), off


def _run(loop: Points) -> Vector:
    steps = np.linalg.norm(np.diff(np.vstack([loop, loop[:1]]), axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def _nearest(loop: Points, place: Vector) -> int:
    return int(np.linalg.norm(loop - place, axis=1).argmin())
