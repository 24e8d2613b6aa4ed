"""One section of a surface: points of S all round, with what is known of each."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from bladecad.arrays import Mask, Points, Vector, seal
from bladecad.data.sections import Section


@final
@dataclass(frozen=True, eq=False)
class Cut:
    """One section of a surface: a loop from the leading edge along the suction side and back.

    name    : of the section
    place   : where it was cut: height of the plane or radius of the cylinder, mm; u of a stream
    u, t    : (n,) float, span and chordwise place of each point
    suction : (n,) bool, the side of each point; an edge point that both share counts as suction
    points  : (n, 3) float, mm, S(side, u, t); the first point is not repeated at the end
    normals : (n, 3) float, unit normals of the surface there, out of the metal
    le, te  : numbers of the edge points, two where the edge is cut off; as in `Section`
    error   : mm, largest distance of the points from the plane or cylinder
    between : mm, largest distance of the cubic spline through the points from the surface's own
              section, half-way between them
    """

    name: str
    place: float
    u: Vector
    t: Vector
    suction: Mask
    points: Points
    normals: Points
    le: tuple[int, ...]
    te: tuple[int, ...]
    error: float
    between: float

    def __post_init__(self) -> None:
        n = len(self.t)
        seal(self, u=(n,), t=(n,), points=(n, 3), normals=(n, 3))

    @property
    def section(self) -> Section:
        """The same as a section of a file."""
        closed = len(self.le) == 1
        return Section(self.name, self.points, closed, self.le, self.te, suction="first")
