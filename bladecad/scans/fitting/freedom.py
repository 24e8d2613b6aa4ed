"""How a surface may move: in the span of its own functions, its sides joined at the edges."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final, NamedTuple, final

import numpy as np
from scipy.linalg import block_diag, lstsq, null_space, svd

from bladecad.arrays import Array, Vector, seal
from bladecad.fit.joint import edge_conditions, unit_rows
from bladecad.fit.sidefit import SideFit
from bladecad.scans.fitting.local import Splines
from bladecad.surface.blade import BladeSurface
from bladecad.surface.loft import graded

PLACES: Final = 1500  # at which functions are compared
TOLD_APART: Final = 1e-7  # singular values below this share of the first are no freedom


class Pair(NamedTuple):
    """Something of both sides."""

    suction: Array
    pressure: Array


@final
@dataclass(frozen=True, eq=False)
class Freedom:
    """The ways in which each section can move, in either coordinate across the stacking axis.

    axes   : (2, 3) float, the two directions across the stacking axis
    in_u   : splines along the span
    in_t   : splines along the side, in which sums over points are made
    local  : (nt, f) float a side; the ways in those splines
    own    : (n, f) float a side; the ways in the functions of the surface
    """

    axes: Array
    in_u: Splines
    in_t: Splines
    local: Pair
    own: Pair

    def __post_init__(self) -> None:
        seal(self, axes=(2, 3))

    @property
    def ways(self) -> int:
        """Number f of ways."""
        return int(self.own.suction.shape[1])


def freedom(surface: BladeSurface, in_t: Splines, axis: Vector) -> Freedom:
    """Find all ways to move the sections of a surface that keep its edges joined, curvature too.

    Orthonormal at graded places, so that nearly collinear functions do no harm; what remains of
    the surface's functions after B (C_S, C_P) = 0.

    Parameters
    ----------
    surface : BladeSurface
        One basis a side, four sections at least, law "spline".
    in_t : Splines
        Fine enough to hold its functions.
    axis : (3,) float, unit
    """
    S, P = surface.suction.bases[0], surface.pressure.bases[0]
    t = graded(PLACES)
    Phi = block_diag(S(t), P(t))
    scale = 1.0 / np.linalg.norm(Phi, axis=0)
    B = unit_rows(edge_conditions(S, P, surface.le, surface.te) * scale)
    N = null_space(B) if len(B) else np.eye(len(scale))
    U, s, Vt = svd((Phi * scale) @ N, full_matrices=False)
    kept = s > TOLD_APART * s[0]
    ways = N @ (Vt[kept].T / s[kept])
    own = scale[:, None] * (ways - B.T @ (B @ ways))  # rounding, divided by small s, taken off
    local = _in_local(in_t, t, U[:, kept])
    axes = np.linalg.svd(np.asarray(axis)[None])[2][1:]
    halves = Pair(own[: S.size], own[S.size :])
    return Freedom(axes, Splines(surface.knots[0]), in_t, local, halves)


def _in_local(in_t: Splines, t: Vector, U: Array) -> Pair:
    Phi = in_t(t)
    suction, pressure = (lstsq(Phi, half)[0] for half in np.split(U, 2))
    return Pair(suction, pressure)


def moved(surface: BladeSurface, free: Freedom, y: Array) -> BladeSurface:
    """Move the surface, y of shape (nu, 2, f): poles along u of every way in both coordinates."""
    at_nodes = np.einsum("mk,kaf->maf", free.in_u(surface.span), y)
    sides = [
        SideFit(
            side.bases, side.coefficients + np.einsum("maf,nf,ax->mnx", at_nodes, own, free.axes)
        )
        for side, own in zip((surface.suction, surface.pressure), free.own, strict=True)
    ]
    return replace(surface, suction=sides[0], pressure=sides[1])


def local_poles(surface: BladeSurface, free: Freedom) -> Pair:
    """The surface itself in the local splines, (nu, nt, 2) a side, mm."""
    t = graded(PLACES)
    Phi = free.in_t(t)
    found = []
    for side in (surface.suction, surface.pressure):
        curves = np.einsum("mtx,ax->tma", side(t), free.axes)
        at_nodes = lstsq(Phi, curves.reshape(len(t), -1))[0].reshape(Phi.shape[1], -1, 2)
        found.append(np.einsum("km,lma->kla", surface.cardinal, at_nodes))
    return Pair(found[0], found[1])
