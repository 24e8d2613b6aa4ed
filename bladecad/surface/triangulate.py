"""The blade as triangles: a structured grid on every face, closed, with a measured chord error."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from bladecad.arrays import Array, Points, Vector, seal
from bladecad.errors import GeometryError
from bladecad.surface.blade import BladeSurface, SideName, normals
from bladecad.surface.loft import graded
from bladecad.surface.ruled import Triangles, rows_needed, rule

SIDES: tuple[SideName, SideName] = ("suction", "pressure")
ALONG_T, ALONG_U, TWIST = 0.6, 0.25, 1.2  # shares of the chord error; twist is worst at a point
MOST_ROUNDS = 8
VOLUME = 1e-4  # relative
LARGEST = 4_000_000  # triangles


@final
@dataclass(frozen=True, eq=False)
class BladeMesh:
    """A closed triangle mesh with named faces that share their vertices.

    vertices    : (n, 3) float, mm
    faces       : name of each face to its (k, 3) vertex numbers, counter-clockwise from outside
    u, t        : the parameters of the grid
    chord_error : largest distance between triangles and faces along the normal, measured, mm
    rim_error   : largest distance of the border of hub and tip from its curve, measured, mm
    """

    vertices: Points
    faces: dict[str, Triangles]
    u: Vector
    t: Vector
    chord_error: float
    rim_error: float

    def __post_init__(self) -> None:
        seal(self, vertices=(None, 3), u=(None,), t=(None,))

    @property
    def triangles(self) -> Triangles:
        """All triangles, (k, 3)."""
        return np.concatenate(list(self.faces.values()))

    @property
    def volume(self) -> float:
        """Volume inside, mm^3."""
        a, b, c = np.moveaxis(self.vertices[self.triangles] - self.vertices[0], 1, 0)
        return float(np.einsum("kx,kx->", a, np.cross(b, c)) / 6.0)


def triangulate(
    surface: BladeSurface, *, chord_error: float, volume: float | None = None
) -> BladeMesh:
    """Triangulate a closed blade so that no triangle is further from it than `chord_error`.

    Parameters
    ----------
    surface : BladeSurface
    chord_error : float
        mm. The grid follows the curvature, |X_tt . n| h^2 / 8 and the same in u; what it reaches
        is measured at the middles of all edges and triangles, and refined until it is met.
    volume : float, optional
        mm^3; refine also until the volume inside is right to 1e-4. Flat triangles cut off a thin
        blade more than the chord error suggests.

    Raises
    ------
    GeometryError
        If the bound would take more than four million triangles.
    """
    refine = 1.0
    for _ in range(MOST_ROUNDS):
        u, t = grid(surface, chord_error / refine**2)
        if 4 * len(u) * len(t) > LARGEST:
            break
        vertices, faces, on_ruled = _assembled(surface, u, t, chord_error)
        reached = max(*(measured(surface, s, u, t) for s in SIDES), on_ruled)
        mesh = BladeMesh(vertices, faces, u, t, reached, rim(surface, t))
        missing = abs(mesh.volume / volume - 1.0) / VOLUME if volume else 0.0
        if reached <= chord_error and missing <= 1.0:
            return mesh
        refine *= 1.05 * np.sqrt(max(reached / chord_error, missing))
    raise GeometryError(
        f"a chord error of {1e3 * chord_error:.3g} um takes more than {LARGEST:,} triangles; "
        "ask for a larger one"
    )


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


def _assembled(
    surface: BladeSurface, u: Vector, t: Vector, chord_error: float
) -> tuple[Points, dict[str, Triangles], float]:
    """Vertices, named triangles, and the chord error of the ruled faces.

    The sides share the vertices of a round or sharp edge; every ruled face shares its border.
    """
    S, P = (surface(s, u, t) for s in SIDES)
    m, n = len(u), len(t)
    on_S = np.arange(m * n).reshape(m, n)
    on_P = on_S + m * n
    if surface.le != "blunt":
        on_P[:, 0] = on_S[:, 0]
    if surface.te != "blunt":
        on_P[:, -1] = on_S[:, -1]
    vertices = np.concatenate([S.reshape(-1, 3), P.reshape(-1, 3)])
    faces = {"SUCTION_SIDE": _strips(on_S), "PRESSURE_SIDE": _strips(on_P)[:, ::-1]}
    ruled = {"HUB": (on_S[0], on_P[0], -1), "TIP": (on_S[-1], on_P[-1], 1)}
    if surface.le == "blunt":
        ruled["LEADING_EDGE"] = (on_S[:, 0], on_P[:, 0], 1)
    if surface.te == "blunt":
        ruled["TRAILING_EDGE"] = (on_S[:, -1], on_P[:, -1], -1)
    rows = max(rows_needed(vertices[a], vertices[b], chord_error) for a, b, _ in ruled.values())
    reached = 0.0
    for name, (a, b, sense) in ruled.items():
        ids, vertices, error = rule(vertices, a, b, rows)
        faces[name], reached = _strips(ids)[:, ::sense], max(reached, error)
    return *_outwards(*_merged(vertices, faces)), reached


def _merged(vertices: Points, faces: dict[str, Triangles]) -> tuple[Points, dict[str, Triangles]]:
    """Vertices that are used, equal ones once."""
    used = np.unique(np.concatenate(list(faces.values())))
    distinct, which = np.unique(vertices[used], axis=0, return_inverse=True)
    place = np.zeros(len(vertices), np.int64)
    place[used] = which
    return distinct, {name: place[k] for name, k in faces.items()}


def _strips(ids: Triangles) -> Triangles:
    """Two triangles for every cell of a grid of vertex numbers, none where two vertices agree."""
    a, b, c, d = ids[:-1, :-1], ids[:-1, 1:], ids[1:, 1:], ids[1:, :-1]
    both = np.stack([np.stack([a, b, c], -1), np.stack([a, c, d], -1)], axis=2).reshape(-1, 3)
    i, j, k = both.T
    return np.asarray(both[(i != j) & (j != k) & (k != i)])


def _outwards(vertices: Points, faces: dict[str, Triangles]) -> tuple[Points, dict[str, Triangles]]:
    a, b, c = np.moveaxis(vertices[np.concatenate(list(faces.values()))] - vertices[0], 1, 0)
    if np.einsum("kx,kx->", a, np.cross(b, c)) < 0:
        return vertices, {name: k[:, ::-1] for name, k in faces.items()}
    return vertices, faces
