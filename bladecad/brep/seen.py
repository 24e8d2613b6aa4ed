"""What a face is like at some of its places: points, normals, derivatives, curvature."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import cadquery as cq
import numpy as np
from OCP.BRep import BRep_Tool
from OCP.gp import gp_Pnt, gp_Vec
from OCP.TopAbs import TopAbs_Orientation

from bladecad.arrays import Array, Vector


def places_of(edge: Any, face: cq.Face, places: Vector) -> Array:
    """Parameters u and t of a face at some places of its edge, (k, 2)."""
    curve = BRep_Tool.CurveOnSurface_s(edge, face.wrapped, 0.0, 1.0)
    return np.array([[(at := curve.Value(place)).X(), at.Y()] for place in places.tolist()])


def look_at(face: cq.Face, places: Array) -> dict[str, Array]:
    """Places (u, t) as a face sees them: t, X, n outward, and derivatives."""
    surface = BRep_Tool.Surface_s(face.wrapped)
    D = np.array([_derivatives(surface, u, t) for u, t in places.tolist()])
    n = np.cross(D[:, 1], D[:, 2])
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    if face.wrapped.Orientation() == TopAbs_Orientation.TopAbs_REVERSED:
        n = -n
    return {"t": places[:, 1], "X": D[:, 0], "n": n, "D": D}


def _derivatives(surface: Any, u: float, t: float) -> list[list[float]]:
    """X, X_u, X_t, X_uu, X_tt, X_ut by the kernel."""
    point, vectors = gp_Pnt(), [gp_Vec() for _ in range(5)]
    surface.D2(u, t, point, *vectors)
    return [[v.X(), v.Y(), v.Z()] for v in (point, *vectors)]


def normal_curvature(side: Mapping[str, Array], across: Array) -> Vector:
    """II(c)/I(c) for the direction c = a X_u + b X_t nearest to `across`."""
    D, n = side["D"], side["n"]
    Xu, Xt = D[:, 1], D[:, 2]
    E, F, G = (np.einsum("ix,ix->i", p, q) for p, q in ((Xu, Xu), (Xu, Xt), (Xt, Xt)))
    e, g, f = (np.einsum("ix,ix->i", D[:, k], n) for k in (3, 4, 5))
    p, q = (np.einsum("ix,ix->i", across, v) for v in (Xu, Xt))
    a, b = G * p - F * q, E * q - F * p
    return np.asarray(
        (e * a**2 + 2.0 * f * a * b + g * b**2) / (E * a**2 + 2.0 * F * a * b + G * b**2)
    )
