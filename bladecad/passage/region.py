"""A flat region inside a closed line, filled with triangles that grow away from the line."""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, TypeAlias

import numpy as np
import shapely
from scipy.spatial import Delaunay, cKDTree

from bladecad.arrays import Array, Mask, Vector
from bladecad.errors import GeometryError
from bladecad.surface.ruled import Triangles

Largest: TypeAlias = Callable[[Array], Vector]

NEAR: Final = 0.7  # of the size there: no inner point is closer to the line
SMOOTH: Final = 6  # rounds of moving every inner point to the middle of its neighbours
ROUNDS: Final = 12
TWELVE: Final = 12  # places of the line asked for the size at a point


def fill(line: Array, *, largest: Largest, growth: float) -> tuple[Array, Triangles]:
    """Fill a region with triangles that keep to its border.

    Parameters
    ----------
    line : (n, 2) float
        The border, counter-clockwise, first point not repeated.
    largest : function
        Of places (k, 2), the size of the triangles there at most.
    growth : float
        Ratio of neighbouring sizes away from the border, above 1.

    Returns
    -------
    inner : (k, 2) float
        New points.
    triangles : (2 k + n - 2, 3) int
        Counter-clockwise; points of the border are numbered first.

    Raises
    ------
    GeometryError
        If the border is too coarse for its bends, so that no such triangles are found.

    Notes
    -----
    Inner points come from a quadtree over the size field h = h_border + (growth - 1) d; then the
    Delaunay triangulation, whose edges include the border where no point lies in the circle over a
    border edge: points that do are left out.
    """
    line = np.asarray(line, dtype=np.float64)
    polygon = shapely.Polygon(line)
    if not polygon.is_valid:
        raise GeometryError(
            f"the border of an end wall crosses itself ({shapely.is_valid_reason(polygon)}); "
            "ask for a smaller size"
        )
    shapely.prepare(polygon)
    edges = np.linalg.norm(np.roll(line, -1, axis=0) - line, axis=1)
    h = 0.5 * (edges + np.roll(edges, 1))
    inner = _leaves(line, h, largest, growth - 1.0)
    inner = inner[_inside(polygon, line, inner, _size(line, h, inner, largest, growth - 1.0))]
    for _ in range(SMOOTH):
        inner = _smoothed(line, inner, polygon)
    for _ in range(ROUNDS):
        points = np.concatenate([line, inner])
        triangles = _triangles(points, len(line), polygon)
        missing = _missing(triangles, len(line))
        if len(triangles) == 2 * len(inner) + len(line) - 2 and not len(missing):
            return inner, triangles
        keep = ~_in_circles(line, inner, missing)
        if keep.all():
            break
        inner = inner[keep]
    raise GeometryError(
        f"{len(missing)} of {len(line)} border edges of an end wall are not met by triangles; "
        "ask for a smaller size"
    )


def _size(line: Array, h: Vector, points: Array, largest: Largest, slope: float) -> Vector:
    far, near = cKDTree(line).query(points, k=min(TWELVE, len(line)))
    return np.asarray(np.minimum((h[near] + slope * far).min(axis=1), largest(points)))


def _leaves(line: Array, h: Vector, largest: Largest, slope: float) -> Array:
    """Centres of the leaves of a quadtree, split where cells are larger than the size there."""
    low, high = line.min(axis=0), line.max(axis=0)
    cell = float(min(largest(line).max(), (high - low).max()))
    count = np.ceil((high - low) / cell).astype(int) + 1
    x, y = (low[k] + cell * (np.arange(count[k]) + 0.25) for k in (0, 1))
    cells = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    leaves = []
    quarter = np.array([[-1, -1], [-1, 1], [1, -1], [1, 1]]) / 4.0
    while len(cells):
        split = _size(line, h, cells, largest, slope) < 0.75 * cell
        leaves.append(cells[~split])
        cells = (cells[split][:, None] + cell * quarter).reshape(-1, 2)
        cell *= 0.5
    return np.concatenate(leaves)


def _inside(polygon: shapely.Polygon, line: Array, points: Array, size: Vector) -> Mask:
    within = shapely.contains_xy(polygon, points[:, 0], points[:, 1])
    ring = shapely.LinearRing(line)
    shapely.prepare(ring)
    away = np.zeros(len(points))
    away[within] = shapely.distance(ring, shapely.points(points[within]))
    return np.asarray(within & (away > NEAR * size))


def _triangles(points: Array, border: int, polygon: shapely.Polygon) -> Triangles:
    """Delaunay triangles inside, counter-clockwise."""
    found = Delaunay(points).simplices.astype(np.int64)
    a, b, c = np.moveaxis(points[found], 1, 0)
    area = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    found = np.where(area[:, None] < 0, found[:, ::-1], found)
    middle = (a + b + c) / 3.0
    inside = shapely.contains_xy(polygon, middle[:, 0], middle[:, 1])
    longest = np.max([np.sum((q - p) ** 2, axis=1) for p, q in ((a, b), (b, c), (c, a))], axis=0)
    flat = (np.abs(area) < 1e-9 * longest) & np.all(found < border, axis=1)
    return np.asarray(found[inside & ~flat])


def _missing(triangles: Triangles, border: int) -> Triangles:
    """Border edges i, i + 1 that no triangle has, by their i."""
    n = int(triangles.max()) + 1
    directed = np.concatenate([triangles[:, k] * n + triangles[:, (k + 1) % 3] for k in range(3)])
    i = np.arange(border)
    return i[~np.isin(i * n + np.roll(i, -1), directed)]


def _in_circles(line: Array, inner: Array, edges: Triangles) -> Mask:
    a, b = line[edges], np.roll(line, -1, axis=0)[edges]
    near = cKDTree(inner).query_ball_point(0.5 * (a + b), 0.55 * np.linalg.norm(b - a, axis=1))
    found = np.zeros(len(inner), dtype=bool)
    found[[i for some in near for i in some]] = True
    return found


def _smoothed(line: Array, inner: Array, polygon: shapely.Polygon) -> Array:
    points = np.concatenate([line, inner])
    triangles = _triangles(points, len(line), polygon)
    total, count = np.zeros_like(points), np.zeros(len(points))
    for k in range(3):
        for other in (1, 2):
            np.add.at(total, triangles[:, k], points[triangles[:, (k + other) % 3]])
            np.add.at(count, triangles[:, k], 1.0)
    moved = total[len(line) :] / np.maximum(count[len(line) :, None], 1.0)
    good = shapely.contains_xy(polygon, moved[:, 0], moved[:, 1]) & (count[len(line) :] > 0)
    return np.asarray(np.where(good[:, None], moved, inner))
