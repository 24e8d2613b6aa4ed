"""What sizes a blade takes where none are asked."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from bladecad.cfd.openfoam import Cells
from bladecad.meshes.curvature import largest_curvature
from bladecad.meshes.sizing import Sizing
from bladecad.surface.blade import BladeSurface, EdgeKind

A_CHORD: Final = 40.0  # steps, where no size is asked
BASE: Final = 4.0  # cells of the box, in sizes, at most
AROUND: Final = 12.0  # reach of the box beyond the blade, in sizes
RADII: Final = 1.75  # cells on a round edge, in its least radius; at 2 some snap 0.25 of a cell off
THICKNESS: Final = 0.5  # cells on the blade, in the greatest thickness of its thinnest section
SMALLEST: Final = 1.0 / 32.0  # cells on an edge, in sizes, where none are asked


def sizing_for(
    surface: BladeSurface,
    *,
    size: float | None = None,
    chord_error: float = 0.01,
    growth: float = 1.2,
    edge: float | None = None,
) -> Sizing:
    """What is asked; where no size is, a fortieth of the longest chord, mm."""
    if size is None:
        ends = surface("suction", np.linspace(0.0, 1.0, 9), np.array([0.0, 1.0]))
        size = float(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).max()) / A_CHORD
    return Sizing(size, chord_error, growth, edge)


def cells_for(surface: BladeSurface, sizing: Sizing) -> Cells:
    """Cells of a volume mesh to go with a sizing.

    On the blade no more than half its thickness, where that is least along the span, so that both
    sides are told apart. On an edge the size asked for it; where none is, 1.75 of its least radii,
    but no less than a thirty-second of the size; of a blunt edge half its least width; of a sharp
    one a quarter of the size.
    """
    size = sizing.size
    le, te = _on_edge(surface, 0.0, surface.le, size), _on_edge(surface, 1.0, surface.te, size)
    edge = sizing.edge or max(min(le, te), SMALLEST * size)
    blade = min(size, THICKNESS * _thinnest(surface))
    edge = min(edge, blade)
    base = edge * 2.0 ** math.floor(math.log2(BASE * size / edge))  # halved to just that edge
    return Cells(size, blade, edge, base, AROUND * size)


def _on_edge(surface: BladeSurface, t: float, kind: EdgeKind, size: float) -> float:
    u = np.linspace(0.0, 1.0, 41)
    if kind == "round":
        k = largest_curvature(surface, "suction", u, np.full(len(u), t))
        return RADII / float(np.abs(k).max())
    if kind == "sharp":
        return 0.25 * size
    across = surface("suction", u, np.array([t])) - surface("pressure", u, np.array([t]))
    return 0.5 * float(np.linalg.norm(across, axis=2).min())


def _thinnest(surface: BladeSurface) -> float:
    """Greatest thickness at equal t of the section where that is least, mm."""
    u, t = np.linspace(0.0, 1.0, 21), np.linspace(0.1, 0.9, 33)
    across = np.linalg.norm(surface("suction", u, t) - surface("pressure", u, t), axis=2)
    return float(across.max(axis=1).min())
