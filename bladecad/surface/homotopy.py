"""The homotopy: between sections the data are blended and the flow is found anew, A = A(u)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from scipy.linalg import lstsq

from bladecad.arrays import Array, Lines, Vector, seal
from bladecad.fit.blade import BladeFit
from bladecad.fit.judge import SIDES
from bladecad.fit.matched import MatchedModel, line_flow, places, side_of
from bladecad.fit.spectrum import Spectrum
from bladecad.surface.blade import BladeSurface, SideName
from bladecad.surface.loft import graded

BETWEEN = 8  # flows found anew from one section to the next


@final
@dataclass(frozen=True, eq=False)
class SpanFlow:
    """The linear system at one span, S(u,t) = C exp(A t) z0.

    A     : (n, n) float
    C     : (3, n) float, mm
    z0    : (n,) float
    error : largest distance of this flow from S(u,t), mm; 0 where A does not change with u
    """

    A: Array
    C: Array
    z0: Vector
    error: float

    def __post_init__(self) -> None:
        n = len(self.z0)
        seal(self, A=(n, n), C=(3, n), z0=(n,))


def flow_at(surface: BladeSurface, name: SideName, u: float) -> SpanFlow:
    """Find A(u), C(u), z0(u) of one side at any span.

    With one spectrum for all sections the blend of the curves is the blend of C, exactly. Rates
    that vary are blended between the two sections beside u, and C is refitted to the blended
    curve, as the paper does: A(u) = D(u) X(u)^T (X(u) X(u)^T)^-1 in its words.
    """
    bases = surface.side(name).bases
    t = graded(801)
    curve = surface(name, np.array([u]), t)[0]
    spectrum = _spectrum_at(surface, name, u)
    Phi = spectrum(t)
    if len(bases) == 1:
        C = np.einsum("i,inx->nx", surface.blend(np.array([u]))[0], surface.side(name).coefficients)
    else:
        C = lstsq(Phi, curve)[0]
    error = float(np.linalg.norm(Phi @ C - curve, axis=1).max())
    return SpanFlow(spectrum.A, C.T, spectrum(np.zeros(1))[0], error)


def _spectrum_at(surface: BladeSurface, name: SideName, u: float) -> Spectrum:
    """The spectrum at a span: log a and k linear between sections."""
    found = [b for b in surface.side(name).bases if isinstance(b, Spectrum)]
    if len(found) == 1:
        return found[0]
    i = int(np.clip(np.searchsorted(surface.span, u) - 1, 0, len(surface.span) - 2))
    w = (u - surface.span[i]) / (surface.span[i + 1] - surface.span[i])
    below, above = found[i], found[i + 1]
    le, te = (_blended(a, b, w) for a, b in ((below.le, above.le), (below.te, above.te)))
    return Spectrum(below.degree, le, te, below.knots)


def _blended(below: Array, above: Array, w: float) -> Array:
    a = np.exp((1.0 - w) * np.log(below[:, 0]) + w * np.log(above[:, 0]))
    return np.column_stack([a, (1.0 - w) * below[:, 1] + w * above[:, 1]])


def refitted(fit: BladeFit, model: MatchedModel) -> BladeSurface:
    """Blend the data of neighbouring sections linearly and match every blend anew.

    The paper's homotopy, X_j(u) = u X_{j,i} + (1 - u) X_{j,i+1}, eight flows from section to
    section, joined linearly.
    """
    span = fit.lines.span
    inner = span[:-1, None] + np.diff(span)[:, None] * np.arange(BETWEEN) / BETWEEN
    nodes = np.append(inner.ravel(), 1.0)
    sides = []
    for side in SIDES:
        t = places(fit.lines, side)
        rows = _linear(fit.lines.sample(side, t), span, nodes)
        sides.append(side_of([line_flow(row, t, model, "midpoint") for row in rows]))
    return BladeSurface(nodes, sides[0], sides[1], "linear", "blunt", "blunt")


def _linear(points: Lines, span: Vector, nodes: Vector) -> Lines:
    """Points of the sections blended linearly at every node, (k, n, 3)."""
    weights = np.array([np.interp(nodes, span, row) for row in np.eye(len(span))]).T
    return np.asarray(np.einsum("ki,inx->knx", weights, points))
