"""Radii of the edges along the span, as an inspector measures them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from bladecad.arrays import Vector, seal
from bladecad.deviation.sectioning.outlines import Formulas
from bladecad.deviation.sectioning.station import stations_at
from bladecad.surface.blade import BladeSurface, EdgeKind
from bladecad.surface.loft import SIDES


@final
@dataclass(frozen=True, eq=False)
class Edge:
    """One edge along the span.

    kind : "round", "sharp" or "blunt"
    size : (m,) float, mm; radius of the least-squares circle within 60 degrees of the nose of a
           round edge, width of the face of a blunt one, 0 of a sharp one
    """

    kind: EdgeKind
    size: Vector

    def __post_init__(self) -> None:
        seal(self, size=(None,))


def edges(surface: BladeSurface, u: Vector, axis: int) -> tuple[Edge, Edge]:
    """Measure the leading and the trailing edge.

    Parameters
    ----------
    surface : BladeSurface
    u : (m,) float
    axis : {0, 1, 2}
        Column of the machine axis; each section lies in its plane or surface of revolution.
    """
    stations = stations_at(surface, {f"{k}": float(v) for k, v in enumerate(u)}, axis)
    radii = [Formulas(s, (), ()).radii(s.flat[None]) for s in stations]
    found = []
    for name, kind, end in (("leading", surface.le, 0.0), ("trailing", surface.te, 1.0)):
        if kind == "round":
            size = np.array([float(r[f"{name} edge radius"][0]) for r in radii])
        else:
            S, P = (surface(s, u, np.array([end]))[:, 0] for s in SIDES)
            size = np.linalg.norm(S - P, axis=1) if kind == "blunt" else np.zeros(len(u))
        found.append(Edge(kind, size))
    return found[0], found[1]
