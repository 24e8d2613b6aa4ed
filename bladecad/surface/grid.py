"""The grid of parameters on which a blade is triangulated, and how far its triangles stray."""

from __future__ import annotations

import numpy as np

from bladecad.arrays import Array, Vector
from bladecad.surface.blade import BladeSurface, SideName, normals
from bladecad.surface.loft import SIDES, graded

ALONG_T, ALONG_U, TWIST = 0.6, 0.25, 1.2  # shares of the chord error; twist is worst at a point


def grid(surface: BladeSurface, chord_error: float) -> tuple[Vector, Vector]:
    """Parameters u and t whose steps keep the sagitta below the shares of the chord error.

    |X_tt . n| h_t^2 / 8, |X_uu . n| h_u^2 / 8, and for the twist |X_ut . n| h_t h_u / 4.
    """
    u = np.linspace(0.0, 1.0, max(4 * len(surface.span), 25))
    t = graded(801)
    tt, uu, ut = (
        np.max([_normal_part(surface, s, u, t, order) for s in SIDES], axis=0)
        for order in ((0, 2), (2, 0), (1, 1))
    )
    dense_t = _density(tt.max(axis=0), 8.0 * ALONG_T * chord_error)
    dense_u = _density(uu.max(axis=1), 8.0 * ALONG_U * chord_error)
    twist = (ut / dense_t).max(axis=1) / (4.0 * TWIST * chord_error)
    rows = _places(u, np.maximum(dense_u, twist))
    creases = surface.span if surface.law == "linear" else surface.span[[0, -1]]
    return np.union1d(rows, creases), _places(t, dense_t)


def _normal_part(
    surface: BladeSurface, name: SideName, u: Vector, t: Vector, order: tuple[int, int]
) -> Array:
    n = normals(surface, name, u, t)
    return np.asarray(np.abs(np.einsum("utx,utx->ut", surface(name, u, t, *order), n)))


def _density(second: Vector, allowed: float) -> Vector:
    """Steps per unit with |X''| h^2 <= allowed."""
    return np.asarray(np.sqrt(np.maximum(second, 1e-3 * second.max() + 1e-12) / allowed))


def _places(x: Vector, density: Vector) -> Vector:
    """Places from 0 to 1 at the given density."""
    mass = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(x))])
    count = max(int(np.ceil(mass[-1])), 2)
    return np.interp(np.linspace(0.0, mass[-1], count + 1), mass, x)


def measured(surface: BladeSurface, name: SideName, u: Vector, t: Vector) -> float:
    """Largest distance, along the normal, of edge and triangle middles from the surface, mm."""
    X = surface(name, u, t)
    um, tm = 0.5 * (u[1:] + u[:-1]), 0.5 * (t[1:] + t[:-1])
    third_u, third_t = (np.stack([2 * a[:-1] + a[1:], a[:-1] + 2 * a[1:]]) / 3.0 for a in (u, t))
    a, b, c, d = X[:-1, :-1], X[:-1, 1:], X[1:, 1:], X[1:, :-1]
    middles = [
        (u, tm, 0.5 * (X[:, 1:] + X[:, :-1])),
        (um, t, 0.5 * (X[1:] + X[:-1])),
        (um, tm, 0.5 * (a + c)),
        (third_u[0], third_t[1], (a + b + c) / 3.0),
        (third_u[1], third_t[0], (a + c + d) / 3.0),
    ]
    return max(_largest(surface, name, *middle) for middle in middles)


def rim(surface: BladeSurface, t: Vector) -> float:
    """Largest distance, across the curve, of the middles of the rim's edges from hub and tip, mm.

    The rim bends within the surface too, which the distance along the normal does not see.
    """
    ends, tm = np.array([0.0, 1.0]), 0.5 * (t[1:] + t[:-1])
    found = 0.0
    for s in SIDES:
        X, T = surface(s, ends, t), surface(s, ends, tm, 0, 1)
        T = T / np.linalg.norm(T, axis=2, keepdims=True)
        away = surface(s, ends, tm) - 0.5 * (X[:, 1:] + X[:, :-1])
        across = away - T * np.einsum("utx,utx->ut", away, T)[:, :, None]
        found = max(found, float(np.linalg.norm(across, axis=2).max()))
    return found


def _largest(surface: BladeSurface, name: SideName, u: Vector, t: Vector, flat: Array) -> float:
    away = surface(name, u, t) - flat
    return float(np.abs(np.einsum("utx,utx->ut", away, normals(surface, name, u, t))).max())
