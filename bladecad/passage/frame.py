"""The outer faces of a passage: both periodic faces, inlet and outlet, as grids of vertices."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from typing import Final, TypeAlias, final

import numpy as np

from bladecad.arrays import Vector
from bladecad.passage.channel import STATIONS, Channel
from bladecad.passage.cylinder import from_cylinder, turned
from bladecad.passage.periodic import Camber
from bladecad.passage.vertices import Vertices
from bladecad.surface.ruled import Triangles

Step: TypeAlias = Callable[[Vector], Vector]
Steps: TypeAlias = tuple[Step, Step]

LEAST: Final = 2  # cells in every direction


@final
@dataclass(frozen=True, eq=False)
class Frame:
    """Vertex numbers of the outer faces.

    sigma, v      : of the grid on the periodic faces
    first, second : (len(sigma), len(v)) int, half a pitch below and above the camber in theta;
                    `second` is `first` turned by the pitch
    inlet, outlet : (k + 1, len(v)) int, from `first` to `second`, k even
    """

    sigma: Vector
    v: Vector
    first: Triangles
    second: Triangles
    inlet: Triangles
    outlet: Triangles


def frame_of(
    camber: Camber, vertices: Vertices, *, axis: int, pitch: float, size: float, steps: Steps
) -> Frame:
    """Lay grids on the outer faces.

    size  : mm, of their cells
    steps : along hub and shroud, functions of sigma, mm
    """
    channel = camber.channel
    sigma, v = _along(camber, size, steps), _across(channel, size)
    places = [x.ravel() for x in np.meshgrid(sigma, v, indexing="ij")]
    zrt = np.column_stack([channel(*places), camber(*places) - 0.5 * pitch])
    X = from_cylinder(zrt, axis).reshape(len(sigma), len(v), 3)
    first, second = vertices.add(X), vertices.add(turned(X, axis, pitch))
    count = _round(channel, pitch, size, steps)
    ends = []
    for k in (0, -1):
        inner = [turned(X[k], axis, pitch * j / count) for j in range(1, count)]
        ids = vertices.add(np.array(inner))
        ends.append(np.concatenate([first[k][None], ids, second[k][None]]))
    return Frame(sigma, v, first, second, ends[0], ends[1])


def cells(ids: Triangles) -> Triangles:
    """Two triangles for every cell of a grid of vertex numbers."""
    a, b, c, d = ids[:-1, :-1], ids[1:, :-1], ids[1:, 1:], ids[:-1, 1:]
    return np.stack([np.stack([a, b, c], -1), np.stack([a, c, d], -1)], axis=2).reshape(-1, 3)


def _along(camber: Camber, size: float, steps: Steps) -> Vector:
    """Places along the flow, as far apart on hub, middle and shroud as is allowed there."""
    fine = np.linspace(0.0, 3.0, 1201)
    dense = []
    for v, h in ((0.0, steps[0]), (0.5, lambda x: np.full(len(x), size)), (1.0, steps[1])):
        across = np.full_like(fine, v)
        zr = camber.channel(fine, across)
        away = np.diff(np.column_stack([zr, camber(fine, across)]), axis=0)
        away[:, 2] *= 0.5 * (zr[1:, 1] + zr[:-1, 1])
        dense.append(np.linalg.norm(away, axis=1) / h(0.5 * (fine[1:] + fine[:-1])))
    mass = np.append(0.0, np.cumsum(np.max(dense, axis=0)))
    pieces = []
    for a, b in pairwise(STATIONS):
        low, high = np.interp([a, b], fine, mass)
        count = max(int(np.ceil(high - low)), LEAST)
        pieces.append(np.interp(np.linspace(low, high, count + 1)[:-1], mass, fine))
    return np.append(np.concatenate(pieces), 3.0)


def _across(channel: Channel, size: float) -> Vector:
    sigma = np.linspace(0.0, 3.0, 61)
    low, high = (channel(sigma, np.full_like(sigma, v)) for v in (0.0, 1.0))
    count = int(np.ceil(np.linalg.norm(high - low, axis=1).max() / size))
    return np.linspace(0.0, 1.0, max(count, LEAST) + 1)


def _round(channel: Channel, pitch: float, size: float, steps: Steps) -> int:
    """Cells from one periodic face to the other on inlet and outlet, an even number."""
    least = LEAST
    for v, h in zip((0.0, 1.0), steps, strict=True):
        ends = STATIONS[[0, -1]]
        r = channel(ends, np.full(2, v))[:, 1]
        least = max(least, int(np.ceil(np.max(pitch * r / np.minimum(h(ends), size)))))
    return 2 * ((least + 1) // 2)
