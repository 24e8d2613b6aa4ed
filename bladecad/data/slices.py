"""A mesh of a blade cut into loops, from its hub to its tip, whatever the shape of these."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Mask, Points, Vector, seal
from bladecad.errors import DataError

FACING: Final = 0.7  # cosine of normal and span axis from which on a triangle closes hub or tip
THIRD: Final = 1.0 / 3.0  # of the span at either end, in which hub and tip are looked for
FEWEST: Final = 12  # places that a quadratic is laid through
RIDGE: Final = 0.01  # of the scatter of a full column
CLOSE: Final = 0.05  # gap over length, up to which a loop is closed
WELD: Final = 1e-6  # of the size: vertices closer than this are one
ROUGHEST: Final = 0.05  # of the span; Rotor 37, on cones, 0.002
FLAT: Final = 0.01  # of the span: hub and tip that are quadratic to so much speak for an axis
TRIED: Final = np.linspace(0.03, 0.97, 9)

Triangles = NDArray[np.int64]


@final
@dataclass(frozen=True, eq=False)
class SpanField:
    """How far along the span a place is: 0 on the hub, 1 on the tip, linear between them.

    axis     : (3,) float, unit vector from hub to tip
    hub, tip : (6,) float, height along the axis over the plane across it, coefficients of
               1, x, y, x^2, x y, y^2
    frame    : (2, 3) float, rows x and y of that plane
    centre   : (3,) float, mm
    misfit   : largest distance of a triangle of hub or tip from these, as a share of the span
    """

    axis: Vector
    hub: Vector
    tip: Vector
    frame: Array
    centre: Vector
    misfit: float

    def __post_init__(self) -> None:
        seal(self, axis=(3,), hub=(6,), tip=(6,), frame=(2, 3), centre=(3,))

    def __call__(self, points: Points) -> Vector:
        """The share of the span at every point, (k,)."""
        z, terms = (points - self.centre) @ self.axis, _terms(points, self.frame, self.centre)
        low, high = terms @ self.hub, terms @ self.tip
        return np.asarray((z - low) / (high - low))


def welded(vertices: Points, triangles: Triangles) -> tuple[Points, Triangles]:
    """Join vertices at the same place; triangles that vanish are left out."""
    low, size = vertices.min(axis=0), np.ptp(vertices, axis=0)
    cells = np.round((vertices - low) / (WELD * np.linalg.norm(size))).astype(np.int64)
    keys = (cells[:, 0] << 42) | (cells[:, 1] << 21) | cells[:, 2]  # a million cells each way
    _, first, inverse = np.unique(keys, return_index=True, return_inverse=True)
    corners = inverse.reshape(-1)[triangles]
    a, b, c = corners.T
    return vertices[first], corners[(a != b) & (b != c) & (c != a)]


def span_field(vertices: Points, triangles: Triangles, axis: Vector | None = None) -> SpanField:
    """Find the span of a blade: its axis, unless given, and its hub and tip, flat or not.

    Parameters
    ----------
    vertices : (n, 3) float, mm
    triangles : (m, 3) int
        Of the airfoil alone, or closed at hub and tip; welded.
    axis : (3,) float, optional
        Direction from hub to tip; otherwise, of the principal axes and x, y, z, the one across
        which all slices are single loops that change least in area.

    Raises
    ------
    DataError
        If no direction cuts the mesh into single loops.
    """
    rims = _rims(triangles, len(vertices))
    if axis is not None:
        return _smooth(_field(vertices, triangles, rims, np.asarray(axis) / np.linalg.norm(axis)))
    directions = _directions(vertices, triangles)
    found = [_field(vertices, triangles, rims, a) for a in directions]
    evenness = [_evenness(vertices, triangles, f) / (1.0 + f.misfit / FLAT) for f in found]
    best = int(np.argmax(evenness))
    if evenness[best] <= 0.0:
        raise DataError(
            "no direction cuts the mesh into single loops from hub to tip; is it one blade without "
            "root and platform? give --span-axis"
        )
    return _smooth(found[best])


def _smooth(field: SpanField) -> SpanField:
    """Refuse a hub or tip that no quadratic follows: then the mesh is more than an airfoil."""
    if field.misfit > ROUGHEST:
        raise DataError(
            f"hub or tip is no smooth face: it is off by {field.misfit:.0%} of the span, "
            f"{ROUGHEST:.0%} is allowed; a root, a platform or a shroud? cut the nominal down to "
            "its airfoil, or give --span-axis"
        )
    return field


def loops_at(
    vertices: Points, triangles: Triangles, values: Vector, levels: Vector
) -> Iterator[list[Points]]:
    """Cut a mesh where a field on its vertices, linear between them, takes each level.

    Yields the closed loops of each level, longest first; loops with a gap are closed where it is
    small, left out where it is not.
    """
    corners = values[triangles]
    lowest, highest = corners.min(axis=1), corners.max(axis=1)
    for level in levels:
        chains = _chains(triangles[(lowest <= level) & (highest > level)], values > level)
        lines = [_crossings(vertices, values, level, chain) for chain in chains]
        loops = _joined([line for line in lines if len(line) > 1])
        closed = [loop for loop in loops if len(loop) >= 3 and _gap(loop) <= CLOSE * _length(loop)]
        yield sorted(closed, key=_length, reverse=True)


def _directions(vertices: Points, triangles: Triangles) -> list[Vector]:
    """Principal axes of the skin, weighted by area, and x, y, z."""
    corners = vertices[triangles]
    area = 0.5 * np.linalg.norm(_cross(corners), axis=1)
    middle = corners.mean(axis=1)
    X = middle - np.average(middle, axis=0, weights=area)
    _, axes = np.linalg.eigh(np.einsum("k,kx,ky->xy", area, X, X))
    return [*axes.T[::-1], *np.eye(3)]


def _evenness(vertices: Points, triangles: Triangles, field: SpanField) -> float:
    """Smallest over largest area of the slices, 0 where one is no single, slender loop."""
    areas = []
    for loops in loops_at(vertices, triangles, field(vertices), TRIED):
        if not loops or sum(map(_length, loops[1:])) > CLOSE * _length(loops[0]):
            return 0.0
        area = 0.5 * float(np.linalg.norm(np.sum(np.cross(loops[0], np.roll(loops[0], -1, 0)), 0)))
        if not 0.0 < 4.0 * np.pi * area / _length(loops[0]) ** 2 < 0.6:
            return 0.0
        areas.append(area)
    return min(areas) / max(areas)


def _field(
    vertices: Points, triangles: Triangles, rims: NDArray[np.int64], axis: Vector
) -> SpanField:
    """Hub and tip as quadratic heights over the plane across the axis."""
    centre = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    frame = np.linalg.svd(axis[None])[2][1:]
    corners = vertices[triangles]
    n = _cross(corners)
    facing = n @ axis / np.maximum(np.linalg.norm(n, axis=1), 1e-300)
    z = (vertices - centre) @ axis
    share = (z - z.min()) / np.ptp(z)
    heights, misfits = [], []
    for outwards, depth in ((-axis, share), (axis, 1.0 - share)):
        cap = triangles[(depth[triangles].mean(axis=1) < THIRD) & (np.abs(facing) > FACING)]
        places = np.unique(cap) if len(cap) else rims[depth[rims] < THIRD]
        height, misfit = _height(vertices[places], z[places], frame, centre)
        flat = np.array([float(outwards @ axis) * np.ptp(z) / 2.0, 0.0, 0.0, 0.0, 0.0, 0.0])
        heights.append(flat if height is None else height)
        misfits.append(misfit / float(np.ptp(z)))
    return SpanField(axis, heights[0], heights[1], frame, centre, max(misfits))


def _height(points: Points, z: Vector, frame: Array, centre: Vector) -> tuple[Vector | None, float]:
    """Quadratic through the points, and its largest miss; None and 0 where they are too few."""
    if len(points) < FEWEST:
        return None, 0.0
    terms = _terms(points, frame, centre)
    reach = np.abs(terms[:, 1:3]).max()
    size = reach ** np.array([0, 1, 1, 2, 2, 2])
    small = RIDGE * np.sqrt(len(points)) * np.eye(6)[3:]  # along an outline, curves are flat too
    sides = np.vstack([terms / size, small]), np.append(z, np.zeros(3))
    height = np.linalg.lstsq(*sides)[0] / size
    return np.asarray(height), float(np.abs(z - terms @ height).max())


def _terms(points: Points, frame: Array, centre: Vector) -> Array:
    x, y = ((points - centre) @ frame.T).T
    return np.stack([np.ones(len(x)), x, y, x * x, x * y, y * y], axis=1)


def _rims(triangles: Triangles, count: int) -> NDArray[np.int64]:
    """Vertices on edges that one triangle alone has, (k,)."""
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    keys, times = np.unique(edges.min(axis=1) * count + edges.max(axis=1), return_counts=True)
    alone = keys[times == 1]
    return np.unique(np.concatenate([alone // count, alone % count]))


def _chains(triangles: Triangles, over: Mask) -> list[NDArray[np.int64]]:
    """Edges that the level crosses, in order, one chain a loop; (k, 2), below and above it."""
    high = over[triangles]
    alone = np.where(high.sum(axis=1) == 1, high.argmax(axis=1), (~high).argmax(axis=1))
    turn = (alone[:, None] + np.arange(3)) % 3
    a, b, c = np.take_along_axis(triangles, turn, axis=1).T
    edges = np.stack([np.stack([a, b], 1), np.stack([a, c], 1)], 1).reshape(-1, 2)
    edges = np.where(over[edges[:, :1]], edges[:, ::-1], edges)
    keys, ids = np.unique(edges[:, 0] * len(over) + edges[:, 1], return_inverse=True)
    nodes = np.stack([keys // len(over), keys % len(over)], axis=1)
    return [nodes[chain] for chain in _walk(ids.reshape(-1, 2).tolist(), len(nodes))]


def _walk(pairs: list[list[int]], count: int) -> Iterator[list[int]]:
    """Chains of numbers that stand in pairs, open ones from their ends."""
    beside: list[list[int]] = [[] for _ in range(count)]
    for a, b in pairs:
        beside[a].append(b)
        beside[b].append(a)
    seen = [False] * count
    for start in sorted(range(count), key=lambda k: len(beside[k]) != 1):
        chain, here = [], start
        while not seen[here]:
            seen[here] = True
            chain.append(here)
            here = next((k for k in beside[here] if not seen[k]), here)
        if chain:
            yield chain


def _crossings(vertices: Points, values: Vector, level: float, edges: NDArray[np.int64]) -> Points:
    low, high = values[edges].T
    s = ((level - low) / (high - low))[:, None]
    points = (1.0 - s) * vertices[edges[:, 0]] + s * vertices[edges[:, 1]]
    apart = np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1)
    return np.asarray(points[apart > 1e-9 * apart.sum()])


def _joined(lines: list[Points]) -> list[Points]:
    """Lines that end where another one begins become one: sides that do not share an edge."""
    lines = sorted(lines, key=_length, reverse=True)
    loops = []
    while lines:
        line = lines.pop(0)
        while lines and _gap(line) > WELD * _length(line):
            ends = [min(_apart(line, other), _apart(line, other[::-1])) for other in lines]
            k = int(np.argmin(ends))
            if ends[k] > min(CLOSE * _length(line), _gap(line)):
                break
            other = lines.pop(k)
            line = np.vstack([line, other if _apart(line, other) <= ends[k] else other[::-1]])
        loops.append(line)
    return loops


def _apart(line: Points, other: Points) -> float:
    return float(np.linalg.norm(line[-1] - other[0]))


def _cross(corners: Array) -> Array:
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def _gap(loop: Points) -> float:
    return float(np.linalg.norm(loop[0] - loop[-1]))


def _length(loop: Points) -> float:
    return float(np.linalg.norm(np.diff(loop, axis=0), axis=1).sum())
