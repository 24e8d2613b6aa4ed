"""The blade surface S(u,t): flows from edge to edge, blended along the span."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal, final

import numpy as np

from bladecad.arrays import Array, Vector, frozen, seal
from bladecad.fit.sidefit import SideFit
from bladecad.splines import basis, clamped, not_a_knot

Law = Literal["spline", "linear"]
SideName = Literal["suction", "pressure"]
EdgeKind = Literal["round", "sharp", "blunt"]


@final
@dataclass(frozen=True, eq=False)
class BladeSurface:
    """Both sides of a blade, S(u,t) = sum_i L_i(u) C_i exp(A_i t) z_i.

    span      : (m,) float, u of the sections, from 0 at the hub to 1 at the tip
    suction, pressure : flows of every section, t from 0 (LE) to 1 (TE)
    law       : "spline" blends by the C2 spline through the sections, "linear" is the paper's
    le, te    : kind of the edges; sides meet at a round or sharp one, a blunt one has a face

    L_i are the cardinal functions of the law, L_i(u_j) = 1 for i = j, else 0. With one spectrum for
    all sections this is S(u,t) = C(u) exp(A t) z0; blending the curves is blending C.
    """

    span: Vector
    suction: SideFit
    pressure: SideFit
    law: Law = "spline"
    le: EdgeKind = "round"
    te: EdgeKind = "round"

    def __post_init__(self) -> None:
        seal(self, span=(len(self.suction.coefficients),))

    def side(self, name: SideName) -> SideFit:
        """The flows of one side."""
        return self.suction if name == "suction" else self.pressure

    @cached_property
    def knots(self) -> tuple[Vector, int]:
        """Knots and degree of the law along the span."""
        if self.law == "linear" or len(self.span) == 2:
            return frozen(clamped(self.span, 1)), 1
        knots, degree = not_a_knot(self.span)
        return frozen(knots), degree

    @cached_property
    def cardinal(self) -> Array:
        """(m, m) float: column i holds the B-spline coefficients of L_i."""
        knots, degree = self.knots
        return frozen(np.linalg.inv(basis(knots, degree, self.span)))

    def blend(self, u: Vector, order: int = 0) -> Array:
        """L_i(u), or a derivative, (len(u), m)."""
        knots, degree = self.knots
        return basis(knots, degree, np.asarray(u, dtype=np.float64), order) @ self.cardinal

    def __call__(self, name: SideName, u: Vector, t: Vector, du: int = 0, dt: int = 0) -> Array:
        """S or a partial derivative on the grid u x t, (len(u), len(t), 3), mm."""
        curves = self.side(name)(np.asarray(t, dtype=np.float64), dt)
        return np.tensordot(self.blend(u, du), curves, 1)  # ui,itx->utx

    def at(self, name: SideName, u: Vector, t: Vector, du: int = 0, dt: int = 0) -> Array:
        """S or a partial derivative at the places (u_k, t_k), (k, 3), mm."""
        curves = self.side(name)(np.asarray(t, dtype=np.float64), dt)
        return np.asarray(np.einsum("ki,ikx->kx", self.blend(u, du), curves))


def normals(surface: BladeSurface, name: SideName, u: Vector, t: Vector) -> Array:
    """Unit normals on the grid u x t, out of the metal, (len(u), len(t), 3)."""
    n = np.cross(surface(name, u, t, 1, 0), surface(name, u, t, 0, 1))
    n = n / np.linalg.norm(n, axis=2, keepdims=True)
    return np.asarray(n * outward(surface, name))


def outward(surface: BladeSurface, name: SideName) -> float:
    """1 where S_u x S_t points out of the metal on that side, else -1.

    Told once for the whole blade by its signed volume: the flux of x/3 through the closed surface.
    """
    u, t = np.linspace(0.02, 0.98, 15), np.linspace(0.02, 0.98, 25)
    across = surface("suction", u, t) - surface("pressure", u, t)
    n = np.cross(surface("suction", u, t, 1, 0), surface("suction", u, t, 0, 1))
    sign = 1.0 if np.einsum("utx,utx->", across, n) > 0 else -1.0
    return sign if name == "suction" else -sign


def principal_curvatures(
    surface: BladeSurface, name: SideName, u: Vector, t: Vector
) -> tuple[Array, Array]:
    """Principal curvatures on the grid u x t, 1/mm, larger first, positive where convex.

    Eigenvalues of the shape operator, from the first and second fundamental forms
    (do Carmo, Differential Geometry of Curves and Surfaces, section 3-3).
    """
    Su, St = surface(name, u, t, 1, 0), surface(name, u, t, 0, 1)
    n = normals(surface, name, u, t)
    E, F, G = (np.einsum("utx,utx->ut", a, b) for a, b in ((Su, Su), (Su, St), (St, St)))
    e, f, g = (
        -np.einsum("utx,utx->ut", surface(name, u, t, *d), n) for d in ((2, 0), (1, 1), (0, 2))
    )
    area = E * G - F**2
    K = (e * g - f**2) / area
    H = 0.5 * (e * G - 2.0 * f * F + g * E) / area
    root = np.sqrt(np.maximum(H**2 - K, 0.0))
    return H + root, H - root
