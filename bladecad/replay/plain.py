"""The paper's own fit on the suction lines: what its figures 2, 4 and 5 show."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final, final

import numpy as np

from bladecad.arrays import Lines, Vector
from bladecad.fit.flow import evaluate, trajectory_rk4
from bladecad.fit.matching import MatchingFit
from bladecad.fit.steps import Spacing
from bladecad.replay.curves import distance
from bladecad.replay.matched import matched_fits
from bladecad.replay.subject import Region, Stretch, Subject

SPACINGS: Final[tuple[Spacing, Spacing]] = ("uniform", "arc-length")
SUBSTEPS: Final = 8  # Runge-Kutta steps from point to point


@final
@dataclass(frozen=True, eq=False)
class Plain:
    """The suction lines of a blade by eqs. (2)-(8), forward differences, started at X_1.

    fits : one a line
    """

    region: Region
    spacing: Spacing
    stretch: Stretch
    fits: tuple[MatchingFit, ...]

    @cached_property
    def curves(self) -> Lines:
        """The lines by the matrix exponential, at the parameters of the points, (m, k, 3), mm."""
        return np.array([evaluate(fit.flow, fit.t) for fit in self.fits])

    @cached_property
    def absolute(self) -> Vector:
        """Maximum absolute error of each line, max |l(t_n) - X_n|, mm."""
        return np.asarray(distance(self.curves, self.stretch.points).max(axis=1))

    @cached_property
    def relative(self) -> Vector:
        """Maximum relative error of each line, max |l(t_n) - X_n| / |X_n|."""
        sizes = np.linalg.norm(self.stretch.points, axis=2)
        return np.asarray((distance(self.curves, self.stretch.points) / sizes).max(axis=1))

    @cached_property
    def runge_kutta(self) -> float:
        """Largest distance of 4th-order Runge-Kutta from the exponential, over the line's size."""
        lines = [trajectory_rk4(fit.flow, fit.t, SUBSTEPS) for fit in self.fits]
        away = distance(np.array(lines), self.curves).max(axis=1)
        return float(np.max(away / np.abs(self.curves).max(axis=(1, 2))))


def plain(subject: Subject, spacing: Spacing) -> Plain:
    """Fit the suction lines as the paper does."""
    fits = matched_fits(subject.suction, spacing, "paper", "forward")
    return Plain(subject.region, spacing, subject.suction, tuple(fits))
