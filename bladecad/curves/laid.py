"""One section of a blade, dense and laid flat, to be measured there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from bladecad.arrays import Array, Points, Vector, seal
from bladecad.curves.develop import Kind, cylindrical, develop
from bladecad.curves.outline import Track
from bladecad.curves.sides import BladeLines

STEP = 1.5e-3  # of a side between samples, at most
FEWEST = 3  # samples a gap
CLOSE = 1e-9  # of a side: the same place
FACE = np.linspace(0.0, 1.0, 14)[1:-1, None]  # on the face of a cut-off edge


@final
@dataclass(frozen=True, eq=False)
class Laid:
    """The outline of a section as a dense flat loop.

    points  : (n, 3) float, mm; along the suction side to the trailing edge, back along the other
    flat    : (n, 2) float, mm; the same laid flat, seen from outside the machine
    scale   : (n,) float; true length over flat length there
    le, te  : the numbers of the points at the edges: one, or the two corners of a cut-off edge,
              that of the suction side first
    kind    : "plane" or "revolution", what was laid flat
    axis    : column of the machine axis
    """

    points: Points
    flat: Points
    scale: Vector
    le: tuple[int, ...]
    te: tuple[int, ...]
    kind: Kind
    axis: int

    def __post_init__(self) -> None:
        n = len(self.points)
        seal(self, points=(n, 3), flat=(n, 2), scale=(n,))

    @property
    def ends(self) -> Array:
        """The leading and the trailing edge in the flat, (2, 2)."""
        return np.array([self.flat[list(edge)].mean(axis=0) for edge in (self.le, self.te)])

    @property
    def chord(self) -> float:
        """Straight distance in space between the edges, mm."""
        le, te = (self.points[list(edge)].mean(axis=0) for edge in (self.le, self.te))
        return float(np.linalg.norm(te - le))

    @property
    def perimeter(self) -> float:
        """Length of the outline, mm."""
        return float(np.linalg.norm(self.points - np.roll(self.points, -1, axis=0), axis=1).sum())

    @property
    def area(self) -> float:
        """Area, mm2."""
        return abs(self._integral(self.flat[:, 1]))

    @property
    def centroid(self) -> Vector:
        """Centroid of the area, (3,), mm."""
        x, y = self.flat.T
        whole = self._integral(y)
        return self._in_space(self._integral(x * y) / whole, self._integral(0.5 * y**2) / whole)

    def _integral(self, inner: Vector) -> float:
        """Integral of d(inner)/dy over the area, by Green's formula."""
        g = inner * self.scale**2
        step = self.flat[:, 0] - np.roll(self.flat[:, 0], -1)
        return float(np.sum(0.5 * (g + np.roll(g, -1)) * step))

    def _in_space(self, x: float, y: float) -> Vector:
        """The point of the plane, or of the surface of revolution, at a place of the flat."""
        if self.kind == "plane":
            terms = np.column_stack([np.ones(len(self.flat)), self.flat])
            map_ = np.linalg.lstsq(terms, self.points, rcond=None)[0]
            return np.asarray(np.array([1.0, x, y]) @ map_)
        order = np.argsort(self.flat[:, 0])
        z, r, theta = cylindrical(self.points, self.axis)
        z0, r0 = (float(np.interp(x, self.flat[order, 0], v[order])) for v in (z, r))
        theta0 = float(np.polynomial.Polynomial.fit(self.flat[:, 1], theta, 1)(y))
        place = np.array([z0, r0 * np.cos(theta0), r0 * np.sin(theta0)])
        return np.asarray(np.roll(place, self.axis))


def lay(lines: BladeLines, k: int, axis: int) -> Laid:
    """Lay section `k` flat, densified, the faces of cut-off edges closed by straight lines."""
    suction, pressure = _dense(lines.suction[k]), _dense(lines.pressure[k])[::-1]
    at_te = _face(suction[-1], pressure[0]) if lines.te == "blunt" else pressure[:0]
    at_le = _face(pressure[-1], suction[0]) if lines.le == "blunt" else pressure[:0]
    back = pressure if lines.te == "blunt" else pressure[1:]
    back = back if lines.le == "blunt" else back[:-1]
    points = np.vstack([suction, at_te, back, at_le])
    flat = develop(points, axis)
    turn, returned = len(suction) - 1, len(suction) + len(at_te)
    te = (turn, returned) if lines.te == "blunt" else (turn,)
    le = (0, returned + len(back) - 1) if lines.le == "blunt" else (0,)
    return Laid(points, flat.points, flat.scale, le, te, flat.kind, axis)


def _dense(track: Track) -> Points:
    """Points of a side from edge to edge: all the measured ones, and evenly spaced between them."""
    ends = np.union1d([0.0, 1.0], track.fractions())
    ends = ends[np.append(True, np.diff(ends) > CLOSE)]
    gaps = np.diff(ends)
    counts = np.maximum(np.ceil(gaps / STEP).astype(int), FEWEST)
    number = np.arange(counts.sum()) - np.repeat(np.cumsum(counts) - counts, counts)
    fractions = np.repeat(ends[:-1], counts) + np.repeat(gaps / counts, counts) * number
    return track(np.append(fractions, 1.0))


def _face(start: Vector, end: Vector) -> Points:
    return np.asarray(start + FACE * (end - start))
