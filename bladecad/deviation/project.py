"""Foot points of any number of points on a nominal blade."""

from __future__ import annotations

import numpy as np

from bladecad.arrays import Array, Points, Vector
from bladecad.deviation import foot
from bladecad.deviation.feet import Feet
from bladecad.deviation.nominal import Nominal
from bladecad.surface.blade import BladeSurface, SideName, outward
from bladecad.surface.grid import grid


def project(nominal: Nominal, points: Points) -> Feet:
    """Find the nearest place of the skin, sides and faces of cut-off edges, for every point.

    Parameters
    ----------
    nominal : Nominal
    points : (k, 3) float, mm
    """
    surface = nominal.surface
    found = foot.project(surface, points, *grid(surface, 0.005))
    at = np.where(
        found.suction[:, None],
        surface.at("suction", found.u, found.t),
        surface.at("pressure", found.u, found.t),
    )
    n = np.where(
        found.suction[:, None],
        _normal(surface, "suction", found.u, found.t),
        _normal(surface, "pressure", found.u, found.t),
    )
    rim = (found.u <= 0.0) | (found.u >= 1.0)
    face = np.where(found.suction, 0, 1).astype(np.int8)
    return Feet(found.distance, at, n, face, found.suction, found.u, found.t, rim)


def _normal(surface: BladeSurface, name: SideName, u: Vector, t: Vector) -> Array:
    n = np.cross(surface.at(name, u, t, 1, 0), surface.at(name, u, t, 0, 1))
    n = n / np.linalg.norm(n, axis=1, keepdims=True)
    return np.asarray(n * outward(surface, name))
