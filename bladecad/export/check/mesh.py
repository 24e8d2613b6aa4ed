"""The blade of the report: triangles fine enough for the eye, each with what its cell measured."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Mask, Points, Vector, seal
from bladecad.deviation.inspecting.coverage import Map
from bladecad.deviation.inspecting.inspection import Inspection
from bladecad.deviation.sectioning.gaps import seal_gaps
from bladecad.export.check.map import bridged, coarser
from bladecad.export.check.zones import zone_at
from bladecad.surface.blade import BladeSurface
from bladecad.surface.grid import grid
from bladecad.surface.loft import SIDES
from bladecad.surface.ruled import Triangles
from bladecad.tolerance import Tolerances

FLAT: Final = 4e-4  # chord error over the length of the blade's diagonal
CAP: Final = -1  # zone of what is not inspected: hub and tip

Cells = dict[str, NDArray[Any]]
Block = tuple[Array, bool, Cells]  # grid of vertices, whether to turn it, its cells


@final
@dataclass(frozen=True, eq=False)
class Painted:
    """A blade to look at.

    vertices  : (n, 3) float, mm
    triangles : (m, 3) int, counter-clockwise from outside
    zone      : (m,) int, number in `ZONES`, -1 on hub and tip
    measured  : (m,) bool, whether the scan reaches the cell
    mean      : (m,) float, mm, of the deviations on the cell; NaN without points
    extreme   : (m,) float, mm, the one of largest size
    """

    vertices: Points
    triangles: Triangles
    zone: NDArray[np.int64]
    measured: Mask
    mean: Vector
    extreme: Vector

    def __post_init__(self) -> None:
        m = len(self.triangles)
        seal(self, vertices=(None, 3))
        seal_gaps(self, mean=(m,), extreme=(m,))

    def __getitem__(self, which: Mask) -> Painted:
        """Some of the triangles, with their vertices only."""
        used, ids = np.unique(self.triangles[which], return_inverse=True)
        return Painted(self.vertices[used], ids.reshape(-1, 3), self.zone[which],
                       self.measured[which], self.mean[which], self.extreme[which])  # fmt: skip


def painted(inspection: Inspection) -> Painted:
    """Return the nominal blade in triangles that carry what the cells of the map measured."""
    surface = inspection.nominal.surface
    chart = bridged(coarser(inspection.map))
    u, t = _lines(surface, chart, inspection.tolerances)
    values = _values(chart, inspection.tolerances, u, t)
    return _merged(list(_blocks(surface, *_sides(surface, u, t), values)))


def _lines(surface: BladeSurface, chart: Map, tolerances: Tolerances) -> tuple[Vector, Vector]:
    """Parameters that hold the borders of cells and zones, and follow the curvature."""
    corners = surface("suction", np.array([0.0, 1.0]), np.array([0.0, 1.0])).reshape(-1, 3)
    size = float(np.linalg.norm(np.ptp(corners, axis=0)))
    u, t = grid(surface, FLAT * size)
    return (
        _filled(chart.u, [tolerances.hub_margin, 1.0 - tolerances.tip_margin], u),
        _filled(chart.t, [tolerances.le_zone, 1.0 - tolerances.te_zone], t),
    )


def _filled(borders: Vector, zones: list[float], smooth: Vector) -> Vector:
    """Borders of cells and zones, and smooth places where they leave wide gaps."""
    lines = np.union1d(borders, zones)
    nearest = np.abs(smooth[:, None] - lines).min(axis=1)
    step = np.gradient(smooth)
    return np.union1d(lines, smooth[nearest > 0.6 * step])


def _values(chart: Map, tolerances: Tolerances, u: Vector, t: Vector) -> Cells:
    """What is known of the middles of the cells of a finer grid, (2, m, n) each."""
    um, tm = 0.5 * (u[1:] + u[:-1]), 0.5 * (t[1:] + t[:-1])
    i, j = (
        np.clip(np.searchsorted(borders, x) - 1, 0, len(borders) - 2)
        for borders, x in ((chart.u, um), (chart.t, tm))
    )
    at = np.ix_(np.arange(2), i, j)
    lower = np.abs(chart.lowest) > np.abs(chart.highest)
    k, U, T = np.meshgrid([True, False], um, tm, indexing="ij")
    return {
        "zone": zone_at(tolerances, k.ravel(), U.ravel(), T.ravel()).reshape(k.shape),
        "measured": chart.measured[at],
        "mean": chart.mean[at],
        "extreme": np.where(lower, chart.lowest, chart.highest)[at],
    }


def _sides(surface: BladeSurface, u: Vector, t: Vector) -> tuple[Array, Array]:
    """Vertices of both sides, which share those of a round or sharp edge."""
    S, P = (surface(side, u, t) for side in SIDES)
    for kind, end in ((surface.le, 0), (surface.te, -1)):
        if kind != "blunt":
            P[:, end] = S[:, end]
    return S, P


def _blocks(surface: BladeSurface, S: Array, P: Array, values: Cells) -> Iterator[Block]:
    """The sides, hub and tip, and cut-off edges in two halves, each with the cells beside it."""
    for k, X in enumerate((S, P)):
        yield X, k == 1, {name: part[k] for name, part in values.items()}
    m = S.shape[1] - 1
    none = np.full(m, np.nan)
    caps = {"zone": np.full(m, CAP), "measured": np.ones(m, bool), "mean": none, "extreme": none}
    yield np.stack([S[0], P[0]]), True, caps
    yield np.stack([S[-1], P[-1]]), False, caps
    for kind, end in ((surface.le, 0), (surface.te, -1)):
        if kind == "blunt":
            middle = 0.5 * (S[:, end] + P[:, end])
            for k, (a, b) in enumerate(((S[:, end], middle), (middle, P[:, end]))):
                beside = {name: part[k][:, end] for name, part in values.items()}
                yield np.stack([a, b]), end == -1, beside


def _merged(blocks: list[Block]) -> Painted:
    """One mesh of all blocks; equal vertices once, the normals of the blade outwards."""
    vertices, triangles, first = [], [], 0
    for X, turn, _ in blocks:
        ids = first + np.arange(X.shape[0] * X.shape[1]).reshape(X.shape[:2])
        vertices.append(X.reshape(-1, 3))
        triangles.append(_strips(ids)[:, :: -1 if turn else 1])
        first += ids.size
    cells = [
        np.concatenate([np.repeat(values[name].ravel(), 2) for _, _, values in blocks])
        for name in ("zone", "measured", "mean", "extreme")
    ]
    distinct, which = np.unique(np.concatenate(vertices), axis=0, return_inverse=True)
    faces = which.ravel()[np.concatenate(triangles)]
    a, b, c = np.moveaxis(distinct[faces] - distinct[0], 1, 0)
    faces = faces if np.einsum("kx,kx->", a, np.cross(b, c)) > 0 else faces[:, ::-1]
    real = (faces != np.roll(faces, 1, axis=1)).all(axis=1)
    return Painted(distinct, faces[real], *(values[real] for values in cells))


def _strips(ids: NDArray[np.int64]) -> Triangles:
    """Two triangles for every cell of a grid of vertex numbers."""
    a, b, c, d = ids[:-1, :-1], ids[:-1, 1:], ids[1:, 1:], ids[1:, :-1]
    return np.stack([np.stack([a, b, c], -1), np.stack([a, c, d], -1)], axis=2).reshape(-1, 3)
