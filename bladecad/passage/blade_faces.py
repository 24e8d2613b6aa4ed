"""The faces of the blade in its passage: both sides, blunt edges, and an end before a gap."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np

from bladecad.arrays import Vector
from bladecad.meshes.edges import edge_zones
from bladecad.meshes.sizing import Sizing, chordwise, spanwise
from bladecad.meshes.strips import capped, zipped
from bladecad.passage.cylinder import from_cylinder, to_cylinder
from bladecad.passage.trim import Trimmed, WallName
from bladecad.passage.vertices import Vertices
from bladecad.surface.ruled import Triangles


@final
@dataclass(frozen=True, eq=False)
class Sides:
    """Vertex numbers of the blade along lines t = const, from hub to tip.

    t                 : (k,) float, of the lines
    rows              : v on each line
    suction, pressure : one line for each t; the same line where the sides meet
    leading, trailing : of a blunt edge, lines from suction to pressure side, else empty
    places            : v and t of every vertex of both sides, by their numbers from `start` on
    """

    t: Vector
    rows: Sequence[Vector]
    suction: Sequence[Triangles]
    pressure: Sequence[Triangles]
    leading: Sequence[Triangles]
    trailing: Sequence[Triangles]
    places: tuple[Vector, Vector]
    start: int

    def end(self, name: WallName) -> tuple[Triangles, Triangles]:
        """Numbers along suction and pressure side on a wall, the latter with its blunt edges.

        Both begin at the suction side's leading edge and end at its trailing edge.
        """
        k = 0 if name == "hub" else -1
        le = [line[k] for line in self.leading[:-1]]
        te = [line[k] for line in self.trailing[-2::-1]]
        suction = [line[k] for line in self.suction]
        pressure = [*le, *(line[k] for line in self.pressure), *te]
        return np.array(suction), np.array(pressure)


def sides_of(blade: Trimmed, vertices: Vertices, sizing: Sizing, angle: float) -> Sides:
    """Lay lines on both sides, as `mesh_blade` does, between the walls."""
    surface = blade.surface
    t = chordwise(surface, sizing)
    rows = spanwise(surface, t, sizing)
    own = slice(0 if surface.le == "blunt" else 1, None if surface.te == "blunt" else -1)
    on_S, on_P = _places(t, rows), _places(t[own], rows[own])
    S = _split(vertices.add(blade.at("suction", *on_S)), rows)
    P = list(S)
    P[own] = _split(vertices.add(blade.at("pressure", *on_P)), rows[own])
    places = np.concatenate([on_S[0], on_P[0]]), np.concatenate([on_S[1], on_P[1]])
    edges: list[Sequence[Triangles]] = [
        _blunt(blade, vertices, S[k], P[k], sizing.size, angle) if kind == "blunt" else ()
        for k, kind in ((0, surface.le), (-1, surface.te))
    ]
    return Sides(t, rows, S, P, edges[0], edges[1], places, int(S[0][0]))


def side_patches(blade: Trimmed, vertices: Vertices, sides: Sides) -> dict[str, Triangles]:
    """Triangles of sides and edges; each patch is wound one way."""
    X, count = vertices.points, len(sides.t)
    patches = {}
    cuts = []
    for le, te in zip(*edge_zones(blade.surface), strict=True):
        first = int(np.searchsorted(sides.t, le * (1.0 - 1e-9)))
        cuts.append((first, count - 1 - int(np.searchsorted(1.0 - sides.t[::-1], te - 1e-12))))
    (s, s_end), (p, p_end) = cuts
    S, P = sides.suction, sides.pressure
    patches = {
        "blade_suction": zipped(X, S[s : s_end + 1]),
        "blade_pressure": zipped(X, P[p : p_end + 1])[:, ::-1],
    }
    for name, strip, on_S, on_P in (
        ("blade_le", sides.leading, S[: s + 1], P[: p + 1]),
        ("blade_te", sides.trailing, S[s_end:], P[p_end:]),
    ):
        around = [zipped(X, strip)] if strip else []
        around += [zipped(X, on_S)] if not strip and len(on_S) > 1 else []
        around += [zipped(X, on_P)[:, ::-1]] if not strip and len(on_P) > 1 else []
        if around:
            patches[name] = np.concatenate(around)
    return patches


def end_patch(
    blade: Trimmed, vertices: Vertices, sides: Sides, name: WallName, size: float, angle: float
) -> Triangles:
    """Triangles of the blade's end before a gap, on the surface of revolution a gap off the wall.

    Ruled in s and theta from suction to pressure side at equal t, every ruling divided as its
    neighbours are apart; the blade's tip patch is wound as its lines run.
    """
    k = 0 if name == "hub" else -1
    S = np.array([line[k] for line in sides.suction])
    P = np.array([line[k] for line in sides.pressure])
    X = vertices.points
    step = np.linalg.norm(np.diff(0.5 * (X[S] + X[P]), axis=0), axis=1)
    apart = 0.5 * (np.append(step, step[-1]) + np.insert(step, 0, step[0]))
    thick = np.linalg.norm(X[S] - X[P], axis=1)
    counts = np.maximum(np.ceil(thick / np.minimum(apart, size)), 1).astype(int)
    lines = []
    for i, (a, b) in enumerate(zip(S, P, strict=True)):
        edge = {0: sides.leading, len(S) - 1: sides.trailing}.get(i, ())
        if a == b:
            lines.append(np.array([a]))
        elif edge:
            lines.append(np.array([line[k] for line in edge]))
        else:
            share = np.arange(1, counts[i]) / counts[i]
            inner = _on_wall(blade, name, X[a], X[b], share, angle)
            lines.append(np.concatenate([[a], vertices.add(inner), [b]]))
    return capped(vertices.points, lines)


def _blunt(
    blade: Trimmed, vertices: Vertices, S: Triangles, P: Triangles, size: float, angle: float
) -> Sequence[Triangles]:
    """Lines across a blunt edge, ruled in cylindrical coordinates, its ends on the walls."""
    X = vertices.points
    zrt = to_cylinder(np.stack([X[S], X[P]]), blade.axis, angle)
    count = max(int(np.ceil(np.linalg.norm(X[S] - X[P], axis=1).max() / size)), 1)
    lines = [S]
    for share in np.arange(1, count) / count:
        between = from_cylinder((1.0 - share) * zrt[0] + share * zrt[1], blade.axis)
        for name, k in (("hub", 0), ("shroud", -1)):
            end: WallName = "hub" if name == "hub" else "shroud"
            between[k] = _on_wall(blade, end, X[S[k]], X[P[k]], np.array([share]), angle)[0]
        lines.append(vertices.add(between))
    return [*lines, P]


def _on_wall(
    blade: Trimmed, name: WallName, a: Vector, b: Vector, share: Vector, angle: float
) -> Vector:
    """Points between two points on a wall (less its gap), (k, 3) mm."""
    wall = blade.wall(name)
    ends = to_cylinder(np.stack([a, b]), blade.axis, angle)
    s = wall.nearest(ends[:, :2])
    zr = wall.above(s[0] + share * (s[1] - s[0]), blade.gap(name))
    theta = ends[0, 2] + share * (ends[1, 2] - ends[0, 2])
    return from_cylinder(np.column_stack([zr, theta]), blade.axis)


def _places(t: Vector, rows: Sequence[Vector]) -> tuple[Vector, Vector]:
    return np.concatenate(rows), np.repeat(t, [len(r) for r in rows])


def _split(ids: Triangles, rows: Sequence[Vector]) -> list[Triangles]:
    return np.split(ids, np.cumsum([len(r) for r in rows])[:-1])
