"""Hub and shroud of a passage as triangles: on their surface of revolution, round the blade."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from bladecad.arrays import Array, Vector
from bladecad.passage.cylinder import from_cylinder, to_cylinder
from bladecad.passage.frame import Frame
from bladecad.passage.periodic import Camber
from bladecad.passage.region import fill
from bladecad.passage.trim import WallName
from bladecad.passage.vertices import Vertices
from bladecad.passage.walls import Wall
from bladecad.surface.ruled import Triangles

DENSE: Final = 201  # places on the camber ahead of the blade, and behind it


@final
@dataclass(frozen=True, eq=False)
class Plane:
    """A wall unrolled, x = R m, y = R theta with m = integral of ds / r; angles are kept.

    radius : mm, R, the largest of the wall: no length on it is larger than in the plane
    steps  : mm, the largest allowed at the places of the wall's table
    """

    wall: Wall
    axis: int
    angle: float
    radius: float
    steps: Vector

    def largest(self, xy: Array) -> Vector:
        """Size of triangles allowed at places of the plane, mm there."""
        _, _, m = self.wall.table
        return np.asarray(np.interp(xy[:, 0] / self.radius, m, self.steps))

    def step(self, s: Vector) -> Vector:
        """Size allowed at places of the wall, mm."""
        return np.interp(s, self.wall.table[0], self.steps)

    def down(self, points: Array) -> Array:
        """Places of points of the wall in the plane, (k, 2) mm."""
        zrt = to_cylinder(points, self.axis, self.angle)
        s, _, m = self.wall.table
        along = np.interp(self.wall.nearest(zrt[:, :2]), s, m)
        return self.radius * np.column_stack([along, zrt[:, 2]])

    def up(self, xy: Array) -> Array:
        """Points on the wall, (k, 3) mm."""
        s, _, m = self.wall.table
        zr = self.wall(np.interp(xy[:, 0] / self.radius, m, s))
        return from_cylinder(np.column_stack([zr, xy[:, 1] / self.radius]), self.axis)


@final
@dataclass(frozen=True, eq=False)
class EndWall:
    """What an end wall is made of: its plane, the camber, and how its triangles grow."""

    name: WallName
    plane: Plane
    camber: Camber
    growth: float

    @property
    def row(self) -> int:
        """Of the frame's grids: 0 at the hub, -1 at the shroud."""
        return 0 if self.name == "hub" else -1

    def step(self, sigma: Vector) -> Vector:
        """Size allowed at places along the flow, mm."""
        return self.plane.step(self.camber.channel.along(self.name, sigma))


def closed_wall(end: EndWall, frame: Frame, vertices: Vertices) -> Triangles:
    """Triangles of a wall that the blade does not touch."""
    f, k = frame, end.row
    line = [f.first[:, k], f.outlet[1:, k], f.second[-2::-1, k], f.inlet[-2:0:-1, k]]
    return _filled(end, vertices, np.concatenate(line))


def cut_wall(
    end: EndWall, frame: Frame, vertices: Vertices, lower: Triangles, upper: Triangles
) -> Triangles:
    """Triangles of a wall round the blade.

    lower, upper : numbers along the blade's sides of smaller and larger theta, from the same
                   leading to the same trailing edge

    The wall is filled in two regions, on both sides of the camber continued to inlet and outlet:
    a blade as thin as it may be then stands between no two points of one region.
    """
    f, k = frame, end.row
    half = len(f.inlet) // 2
    ahead = _continued(end, vertices, f.inlet[half, k], lower, 0)
    behind = _continued(end, vertices, f.outlet[half, k], lower, -1)[::-1]
    below = [
        f.first[:, k], f.outlet[1 : half + 1, k], behind[-2::-1], lower[-2::-1],
        ahead[::-1][1:], f.inlet[half - 1 : 0 : -1, k],
    ]  # fmt: skip
    above = [
        ahead, upper[1:], behind[1:], f.outlet[half + 1 :, k], f.second[-2::-1, k],
        f.inlet[-2:half:-1, k],
    ]  # fmt: skip
    return np.concatenate([_filled(end, vertices, np.concatenate(line)) for line in (below, above)])


def _continued(
    end: EndWall, vertices: Vertices, start: int, side: Triangles, edge: int
) -> Triangles:
    """Numbers from the inlet (edge 0) or outlet (edge -1) along the camber to the blade's edge."""
    points = vertices.points[[start, side[edge], side[1 if edge == 0 else -2]]]
    far, nose, next_to_it = end.plane.down(points)
    curve = _between(end, edge, far, nose)
    length = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(curve, axis=0), axis=1)))
    first = float(np.linalg.norm(next_to_it - nose))
    sizes = end.plane.largest(curve)[::-1]
    back = _graded(length[-1] - length[::-1], first, sizes, end.growth)
    places = length[-1] - back[::-1]
    xy = np.column_stack([np.interp(places, length, curve[:, k]) for k in (0, 1)])
    inner = vertices.add(end.plane.up(xy[1:-1]))
    return np.concatenate([[start], inner, [side[edge]]])


def _between(end: EndWall, edge: int, far: Vector, nose: Vector) -> Array:
    """The camber ahead of the blade or behind it, in the plane, moved onto its two ends."""
    sigma = np.linspace(0.0, 1.0, DENSE) if edge == 0 else np.linspace(3.0, 2.0, DENSE)
    v = np.full_like(sigma, 0.0 if end.name == "hub" else 1.0)
    s, _, m = end.plane.wall.table
    along = np.interp(end.camber.channel.along(end.name, sigma), s, m)
    curve = end.plane.radius * np.column_stack([along, end.camber(sigma, v)])
    share = np.linspace(0.0, 1.0, DENSE)[:, None]
    return np.asarray(curve + (1.0 - share) * (far - curve[0]) + share * (nose - curve[-1]))


def _graded(length: Vector, first: float, sizes: Vector, growth: float) -> Vector:
    """Places from 0 to the end, the first step about `first` mm, growing to the sizes there."""
    places, step = [0.0], min(first, 0.5 * float(length[-1]))
    while places[-1] < length[-1]:
        step = min(step, float(np.interp(places[-1], length, sizes)))
        places.append(places[-1] + step)
        step *= growth
    return np.asarray(places, dtype=np.float64) * float(length[-1] / places[-1])


def _filled(end: EndWall, vertices: Vertices, line: Triangles) -> Triangles:
    flat = end.plane.down(vertices.points[line])
    inner, triangles = fill(flat, largest=end.plane.largest, growth=end.growth)
    ids = np.concatenate([line, vertices.add(end.plane.up(inner))])
    return np.asarray(ids[triangles])
