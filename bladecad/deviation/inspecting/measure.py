"""The deviation of the measured points from the blade that was built from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Mask, Points, Vector, seal
from bladecad.data.sections import Sections
from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.deviation.nearest.project import project
from bladecad.deviation.nearest.referee import Referee, confirm
from bladecad.surface.blade import BladeSurface
from bladecad.surface.triangulate import BladeMesh

EDGE_ZONE = 0.02  # of the side length, at each end


class Row(NamedTuple):
    """One line of the deviation table; lengths in mm."""

    name: str
    points: int
    largest: float
    p99: float
    rms: float
    mean: float


@final
@dataclass(frozen=True, eq=False)
class Deviation:
    """Distances of the measured points from the surface, positive where metal stands outside.

    points, distance : (k, 3) and (k,) float, mm
    section, index   : (k,) int, number of the section and of the point in it, from 0
    suction, u, t    : (k,) side and parameters of the foot point
    set_aside        : (k,) bool, misprints that the fit did not follow
    names            : of the sections
    referee          : what trimesh said
    """

    points: Points
    distance: Vector
    section: NDArray[np.intp]
    index: NDArray[np.intp]
    suction: Mask
    u: Vector
    t: Vector
    set_aside: Mask
    names: tuple[str, ...]
    referee: Referee

    def __post_init__(self) -> None:
        k = len(self.distance)
        seal(self, points=(k, 3), distance=(k,), u=(k,), t=(k,))

    @property
    def largest(self) -> float:
        """Largest distance of any point that was not set aside, mm."""
        return float(np.abs(self.distance[~self.set_aside]).max())

    def worst(self) -> tuple[str, int]:
        """Name of the section, and number in it, of the point furthest away."""
        k = int(np.where(self.set_aside, 0.0, np.abs(self.distance)).argmax())
        return self.names[self.section[k]], int(self.index[k])

    def table(self) -> list[Row]:
        """Rows for all points, each side, each edge zone and each section."""
        groups = {
            "all": np.ones(len(self.t), bool),
            "suction side": self.suction,
            "pressure side": ~self.suction,
            "leading edge": self.t < EDGE_ZONE,
            "trailing edge": self.t > 1.0 - EDGE_ZONE,
        }
        groups |= {f'section "{n}"': self.section == i for i, n in enumerate(self.names)}
        return [row(name, self.distance[g & ~self.set_aside]) for name, g in groups.items()]


def measure(
    surface: BladeSurface,
    mesh: BladeMesh,
    sections: Sections,
    keep: Sequence[Mask] | None = None,
) -> Deviation:
    """Measure every point of the input against the surface; trimesh confirms a sample.

    Parameters
    ----------
    surface, mesh : BladeSurface, BladeMesh
        The blade and its triangulation.
    sections : Sections
        What was measured.
    keep : sequence of (n,) bool, optional
        False for points that were set aside; they are measured but do not count.

    Raises
    ------
    GeometryError
        If surface and triangulation disagree.
    """
    points = np.concatenate([s.points for s in sections.sections])
    counts = [len(s.points) for s in sections.sections]
    feet = project(nominal_of(surface), points)
    kept = np.concatenate(keep) if keep else np.ones(len(points), bool)
    return Deviation(
        points,
        feet.distance,
        np.repeat(np.arange(len(counts)), counts),
        np.concatenate([np.arange(n) for n in counts]),
        feet.suction,
        feet.u,
        feet.t,
        ~kept,
        tuple(s.name for s in sections.sections),
        confirm(mesh, points, feet),
    )


def row(name: str, d: Vector) -> Row:
    """Say how large deviations are, d (k,) in mm."""
    if not len(d):
        return Row(name, 0, 0.0, 0.0, 0.0, 0.0)
    size = np.abs(d)
    return Row(
        name,
        len(d),
        float(size.max()),
        float(np.quantile(size, 0.99)),
        float(np.sqrt(np.mean(d**2))),
        float(d.mean()),
    )
