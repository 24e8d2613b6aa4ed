"""A whole blade as flows: both sides of all sections, their system, and how good they are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, final

from bladecad.curves.sides import BladeLines
from bladecad.fit.judge import Errors
from bladecad.fit.sidefit import SideFit

ModelName = Literal["modal", "segmented", "paper", "affine", "second-order"]
SpectrumKind = Literal["shared", "varying"]


@final
@dataclass(frozen=True)
class Order:
    """Size of a modal fit: pairs of modes at each edge, degree of the core, its knots."""

    le: int
    te: int
    degree: int
    knots: int = 0

    def __str__(self) -> str:
        restarts = f", {self.knots} knots" if self.knots else ""
        return f"{self.le} LE pairs, {self.te} TE pairs, core degree {self.degree}{restarts}"


@final
@dataclass(frozen=True, eq=False)
class BladeFit:
    """Both sides of a blade as flows.

    model             : which kind of linear system
    order             : its size, None for the paper's own models
    suction, pressure : SideFit
    lines             : what was fitted
    errors            : distances from the densified lines
    tolerance         : what was asked for, mm
    rank, free        : directions that the data can tell apart, of the free coefficients there are
    condition         : of the least-squares problem, columns scaled to one
    reason            : why it falls short of the tolerance, or nothing
    """

    model: ModelName
    order: Order | None
    suction: SideFit
    pressure: SideFit
    lines: BladeLines
    errors: Errors
    tolerance: float
    rank: int
    free: int
    condition: float
    reason: str

    @property
    def margin(self) -> float:
        """Tolerance over largest error, above 1 where it is met."""
        return self.tolerance / self.errors.largest
