"""Geometry of many flat loops at once: peaks, slopes, centroids, circles."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Vector

Indices = NDArray[np.intp]
TOP = 0.97  # of the largest circle: its place is the middle of those larger than that


def dot(a: Array, b: Array) -> Array:
    """Scalar product along the last axis."""
    return np.asarray(np.einsum("...x,...x->...", a, b))


def top(y: Array) -> tuple[Indices, Vector]:
    """Where the last axis is largest, by the parabola through three samples: (m,) and offset."""
    k = np.clip(y.argmax(axis=-1), 1, y.shape[-1] - 2)
    a, b, c = (np.take_along_axis(y, k[..., None] + i, -1)[..., 0] for i in (-1, 0, 1))
    bend = a - 2.0 * b + c
    w = np.divide(0.5 * (a - c), bend, out=np.zeros_like(b), where=bend < 0)
    return k, np.clip(w, -1.0, 1.0)


def middle_of_top(r: Array, x: Array) -> Array:
    """Middle of the stretch of x where r is near its largest value, (m,)."""
    w = np.maximum(r - TOP * r.max(axis=1)[:, None], 0.0) * np.gradient(x, axis=1)
    return np.asarray((w * x).sum(axis=1) / w.sum(axis=1))


def peak(y: Array) -> Array:
    """Largest value along the last axis, by the parabola through three samples."""
    k, w = top(y)
    a, b, c = (np.take_along_axis(y, k[..., None] + i, -1)[..., 0] for i in (-1, 0, 1))
    return np.asarray(b + 0.5 * w * (c - a) + 0.5 * w**2 * (a - 2.0 * b + c))


def at(X: Array, k: Indices, w: Vector) -> Array:
    """Rows of X (m, i, x) at sample k + w, by the parabola through three, (m, x)."""
    rows = np.arange(len(X))
    a, b, c = (X[rows, k + i] for i in (-1, 0, 1))
    w = w[:, None]
    return np.asarray(b + 0.5 * w * (c - a) + 0.5 * w**2 * (a - 2.0 * b + c))


def slope(X: Array, i: Indices) -> Array:
    """Unit tangents at some points, by the parabola through each and its neighbours."""
    after, before = X[:, i + 1] - X[:, i], X[:, i] - X[:, i - 1]
    h1, h0 = (np.linalg.norm(step, axis=2)[..., None] for step in (after, before))
    T = after * h0 / h1 + before * h1 / h0
    return np.asarray(T / np.linalg.norm(T, axis=2)[..., None])


def centroids(X: Array) -> Array:
    """Centroids of the areas in loops (m, n, 2), by Green's formula, (m, 2)."""
    x, y = X[..., 0], X[..., 1]
    x1, y1 = np.roll(x, -1, axis=1), np.roll(y, -1, axis=1)
    cross = x * y1 - x1 * y
    place = np.stack([((x + x1) * cross).sum(1), ((y + y1) * cross).sum(1)], axis=1)
    return np.asarray(place / (3.0 * cross.sum(axis=1))[:, None])


def crossing(x: Array, Y: Array, at: Array) -> Array:
    """Where lines Y first reach x = at, by the straight line between two samples, (m, 2)."""
    k = np.maximum((x >= at).argmax(axis=1), 1)
    rows = np.arange(len(x))
    step = x[rows, k] - x[rows, k - 1]
    w = (at - x[rows, k - 1]) / np.where(step == 0.0, np.inf, step)
    return np.asarray(Y[rows, k - 1] + w[:, None] * (Y[rows, k] - Y[rows, k - 1]))


def circle(X: Array, w: Array) -> Array:
    """Radius of the least-squares circle through points (m, i, 2): x^2 + y^2 = 2 a . x + c.

    NaN where fewer than three points have a weight: the outline is no edge there.
    """
    told = (w > 0.0).sum(axis=1) >= 3
    w = np.where(told[:, None], w, 1.0)
    X = X - (np.einsum("mix,mi->mx", X, w) / w.sum(axis=1)[:, None])[:, None]
    A = np.concatenate([2.0 * X, np.ones((*X.shape[:2], 1))], axis=2)
    weighted = A * w[..., None]
    normal = np.swapaxes(weighted, 1, 2) @ A
    right = np.einsum("mia,mi->ma", weighted, dot(X, X))
    a, b, c = (np.linalg.pinv(normal, hermitian=True) @ right[..., None])[..., 0].T
    return np.asarray(np.where(told, np.sqrt(np.maximum(c + a**2 + b**2, 0.0)), np.nan))
