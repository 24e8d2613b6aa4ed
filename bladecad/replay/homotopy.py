"""Between the sections: the paper's blend and refit, and the two laws that blend coefficients."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple, final

import numpy as np

from bladecad.arrays import Array, Lines, Vector
from bladecad.fit.matching import MatchingFit, homotopy
from bladecad.fit.sidefit import SideFit
from bladecad.replay.running import run
from bladecad.replay.subject import Stretch, Subject
from bladecad.surface.between import leave_one_out
from bladecad.surface.blade import BladeSurface, Law, SideName, normals

BETWEEN: Final = 6  # lines from section to section
BESIDE: Final = 1e-9  # of the span: on one side of a section, and on the other
LAWS: Final[tuple[Law, Law]] = ("linear", "spline")
SIDES: Final[tuple[SideName, SideName]] = ("suction", "pressure")


@final
@dataclass(frozen=True, eq=False)
class PaperSurface:
    """S(u,t) = exp(A(u) t) X0(u) by the paper: neighbours blended, refitted at every u.

    u      : (n,) float, span, 0 at the hub
    points : (n, k, 3) float, mm; not finite beyond the floats
    fields : (n, 3, 3) float, A(u)
    """

    u: Vector
    points: Lines
    fields: Array


class Sections(NamedTuple):
    """What one law makes of the inner sections, (m - 2,) each.

    crease    : jump of the normal across the section, largest over both sides, degrees
    left_out  : distance of the section from the surface blended without it, mm
    """

    u: Vector
    crease: Vector
    left_out: Vector


def paper_surface(stretch: Stretch) -> PaperSurface:
    """Blend and refit from section to section, arc-length steps and forward differences."""
    span, points = stretch.lines.span, stretch.points
    v = np.arange(BETWEEN) / BETWEEN
    u: list[float] = []
    fits: list[MatchingFit] = []
    for i in range(len(span) - 1):
        last = i == len(span) - 2
        places = np.append(v, 1.0) if last else v
        u.extend(span[i] + places * (span[i + 1] - span[i]))
        fits.extend(homotopy(points[i], points[i + 1], 1.0 - places))
    return PaperSurface(np.array(u), _points(fits), np.array([f.flow.A for f in fits]))


def studied(surface: BladeSurface) -> Sections:
    """Measure crease and leave-one-out error at the inner sections."""
    crease = np.max([_crease(surface, side) for side in SIDES], axis=0)
    return Sections(surface.span[1:-1], crease, leave_one_out(surface)[1:-1])


def blended(subject: Subject, fits: tuple[SideFit, SideFit], law: Law) -> BladeSurface:
    """Blend the flows of a fit along the span."""
    span = subject.suction.lines.span
    return BladeSurface(span, *fits, law, subject.le, subject.te)


def _crease(surface: BladeSurface, side: SideName) -> Vector:
    t = np.linspace(0.0, 1.0, 201)
    below, above = (
        normals(surface, side, surface.span[1:-1] + away, t) for away in (-BESIDE, BESIDE)
    )
    half = np.linalg.norm(above - below, axis=2).max(axis=1) / 2
    return np.asarray(np.degrees(2 * np.arcsin(np.minimum(half, 1.0))))


def _points(fits: list[MatchingFit]) -> Lines:
    return np.array([run(fit.flow, fit.t) for fit in fits])
