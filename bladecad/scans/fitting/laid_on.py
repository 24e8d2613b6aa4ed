"""A surface written anew: in other functions along the sides, at other stations along the span."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.linalg import block_diag, lstsq, null_space

from bladecad.arrays import Vector
from bladecad.curves.sides import BladeLines
from bladecad.data.sections import Section, Sections, Source
from bladecad.fit.joint import edge_conditions, unit_rows
from bladecad.fit.samples import by_section
from bladecad.fit.sidefit import Basis, SideFit
from bladecad.scans.fitting.local import Splines
from bladecad.surface.blade import BladeSurface
from bladecad.surface.loft import SIDES, graded

PLACES: Final = 1500
SPANS: Final = 64  # of a first spline through lines
PER_SPAN: Final = 2  # points of a section cut from a surface, a span of its splines


def through(lines: BladeLines) -> BladeSurface:
    """Return a surface of splines that follows lines; its sides are not yet joined."""
    t, basis = graded(PLACES), Splines.on(graded(SPANS + 1))
    columns = [lines.sample(s, t).transpose(1, 0, 2).reshape(len(t), -1) for s in SIDES]
    sides = [SideFit((basis,), by_section(lstsq(basis(t), Y)[0])) for Y in columns]
    return BladeSurface(lines.span, sides[0], sides[1], "spline", lines.le, lines.te)


def laid_on(surface: BladeSurface, bases: tuple[Basis, Basis], nodes: Vector) -> BladeSurface:
    """Write a surface in given functions of t, its sides joined at the edges, best at all places.

    Parameters
    ----------
    surface : BladeSurface
    bases : pair, suction side first
    nodes : (m,) float
        Stations from 0 to 1.
    """
    t = graded(PLACES)
    S, P = bases
    curves = [surface(s, nodes, t).transpose(1, 0, 2).reshape(len(t), -1) for s in SIDES]
    Phi = block_diag(S(t), P(t))
    scale = 1.0 / np.linalg.norm(Phi, axis=0)
    B = unit_rows(edge_conditions(S, P, surface.le, surface.te) * scale)
    N = null_space(B) if len(B) else np.eye(len(scale))
    Y = N @ lstsq((Phi * scale) @ N, np.concatenate(curves), cond=1e-10)[0]
    C = by_section(scale[:, None] * Y)
    sides = SideFit((S,), C[:, : S.size]), SideFit((P,), C[:, S.size :])
    return BladeSurface(nodes, *sides, "spline", surface.le, surface.te)


def sections_of(surface: BladeSurface, nodes: Vector, breaks: Vector) -> Sections:
    """Cut a surface into dense sections that know their edges and sides."""
    steps = np.arange(PER_SPAN) / PER_SPAN
    t = np.append((breaks[:-1, None] + np.diff(breaks)[:, None] * steps).ravel(), 1.0)
    rows = zip(surface("suction", nodes, t), surface("pressure", nodes, t), strict=True)
    n = len(t)
    le = (2 * n - 1, 0) if surface.le == "blunt" else (0,)
    te = (n - 1, n) if surface.te == "blunt" else (n - 1,)
    found = []
    for k, (suction, pressure) in enumerate(rows, 1):
        back = pressure[::-1] if surface.te == "blunt" else pressure[-2::-1]
        loop = np.vstack([suction, back if surface.le == "blunt" else back[:-1]])
        le_here = (len(loop) - 1, 0) if surface.le == "blunt" else le
        found.append(Section(f"{k}", loop, True, le_here, te, "first"))
    return Sections(tuple(found), Source(None, "surface fitted to a scan"))
