"""The blade as triangles: a structured grid on every face, closed, with a measured chord error."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from bladecad.arrays import Points, Vector, seal
from bladecad.errors import GeometryError
from bladecad.surface.blade import BladeSurface
from bladecad.surface.grid import grid, measured, rim
from bladecad.surface.loft import SIDES
from bladecad.surface.ruled import Triangles, rows_needed, rule

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
