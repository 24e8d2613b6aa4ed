"""The patches of a passage put together, and how far they are from what they stand for."""

from __future__ import annotations

from typing import Final, TypeAlias

import numpy as np

from bladecad.meshes.named import NamedMesh
from bladecad.meshes.sizing import Sizing
from bladecad.meshes.strips import zipped
from bladecad.passage.blade_faces import Sides, end_patch, side_patches, sides_of
from bladecad.passage.channel import SIDES
from bladecad.passage.cylinder import to_cylinder
from bladecad.passage.end_wall import EndWall, Plane, closed_wall, cut_wall
from bladecad.passage.frame import Frame, cells, frame_of
from bladecad.passage.measure import away_from_side, away_from_wall
from bladecad.passage.orient import coherent
from bladecad.passage.periodic import Camber
from bladecad.passage.steps import allowed
from bladecad.passage.trim import WALLS, Trimmed, WallName
from bladecad.passage.vertices import Vertices
from bladecad.surface.ruled import Triangles

Errors: TypeAlias = tuple[float, float]
ENDS: Final[dict[WallName, str]] = {"hub": "blade_hub", "shroud": "blade_tip"}


def meshed(
    blade: Trimmed, camber: Camber, angle: float, count: int, on_walls: Sizing, on_sides: Sizing
) -> tuple[NamedMesh, Triangles, Errors]:
    """The closed mesh, the twins on the periodic faces, the chord errors on walls and blade."""
    store = Vertices()
    ends = _end_walls(blade, camber, angle, on_walls)
    frame = frame_of(
        camber, store, axis=blade.axis, pitch=2.0 * np.pi / count, size=on_walls.size,
        steps=(ends[0].step, ends[1].step),
    )  # fmt: skip
    sides = sides_of(blade, store, on_sides, angle)
    patches, caps = _outer(frame), {}
    for end in ends:
        if blade.gap(end.name) > 0.0:
            patches[end.name] = closed_wall(end, frame, store)
            cap = end_patch(blade, store, sides, end.name, on_sides.size, angle)
            caps[ENDS[end.name]] = cap
        else:
            around = _by_theta(blade, sides, end.name, store, angle)
            patches[end.name] = cut_wall(end, frame, store, *around)
    mesh = coherent(NamedMesh(store.points, patches | side_patches(blade, store, sides) | caps))
    twins = np.column_stack([frame.first.ravel(), frame.second.ravel()])
    return mesh, twins, _chord_errors(mesh, blade, sides)


def _end_walls(
    blade: Trimmed, camber: Camber, angle: float, sizing: Sizing
) -> tuple[EndWall, EndWall]:
    made = []
    for name in WALLS:
        wall = blade.wall(name)
        steps = allowed(wall, size=sizing.size, chord_error=sizing.chord_error)
        plane = Plane(wall, blade.axis, angle, float(wall.points[:, 1].max()), steps)
        made.append(EndWall(name, plane, camber, sizing.growth))
    return made[0], made[1]


def _chord_errors(mesh: NamedMesh, blade: Trimmed, sides: Sides) -> Errors:
    """On the walls, and on the blade."""
    X = mesh.vertices
    on_walls = [away_from_wall(blade, name, X, mesh.patches[name], 0.0) for name in WALLS]
    v, t = (np.full(len(X), np.nan) for _ in range(2))
    own = slice(sides.start, sides.start + len(sides.places[0]))
    v[own], t[own] = sides.places
    lines = sides.suction, sides.pressure
    on_sides = [
        away_from_side(blade, side, X, zipped(X, of), (v, t))
        for side, of in zip(SIDES, lines, strict=True)
    ]
    for name in WALLS:
        if ENDS[name] in mesh.patches:
            cap = mesh.patches[ENDS[name]]
            on_sides.append(away_from_wall(blade, name, X, cap, blade.gap(name)))
    return max(on_walls), max(on_sides)


def _outer(frame: Frame) -> dict[str, Triangles]:
    return {
        "inlet": cells(frame.inlet),
        "outlet": cells(frame.outlet),
        "periodic_1": cells(frame.first),
        "periodic_2": cells(frame.second),
    }


def _by_theta(
    blade: Trimmed, sides: Sides, name: WallName, store: Vertices, angle: float
) -> tuple[Triangles, Triangles]:
    """The blade's lines on a wall, the one of smaller theta first."""
    S, P = sides.end(name)
    X = store.points
    over_S, over_P = (to_cylinder(X[line], blade.axis, angle)[:, 2].mean() for line in (S, P))
    return (S, P) if over_S < over_P else (P, S)
