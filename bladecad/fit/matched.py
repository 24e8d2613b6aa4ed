"""The paper's own models for a whole blade: every line by itself, by matching derivatives."""

from __future__ import annotations

from typing import Literal

import numpy as np

from bladecad.arrays import Lines, Vector
from bladecad.curves.sides import BladeLines
from bladecad.errors import FitError
from bladecad.fit.blade import BladeFit
from bladecad.fit.differences import Scheme
from bladecad.fit.judge import SIDES, Bench, judge
from bladecad.fit.matching import MatchingFit, identify
from bladecad.fit.orbit import Orbit
from bladecad.fit.samples import shared_parameters
from bladecad.fit.sidefit import SideFit

MatchedModel = Literal["paper", "affine", "second-order"]


def fit_matched(
    lines: BladeLines, *, model: MatchedModel, tolerance: float, scheme: Scheme = "midpoint"
) -> BladeFit:
    """Fit every line of a blade by matching derivatives, eqs. (2)-(7) and their descendants.

    The sides do not know each other: they meet neither at the leading nor at the trailing edge.

    Raises
    ------
    FitError
        If a flow leaves the floats; its divergence is real, the model cannot follow that edge.
    """
    fits = [
        _side(lines.sample(s, _places(lines, s)), _places(lines, s), model, scheme) for s in SIDES
    ]
    sides = [side_of(found) for found in fits]
    for name, side in zip(SIDES, sides, strict=True):
        _finite(side, name, model, lines)
    errors = judge(Bench.of(lines), sides[0], sides[1])
    everyone = [fit for found in fits for fit in found]
    return BladeFit(
        model,
        None,
        sides[0],
        sides[1],
        lines,
        errors,
        tolerance,
        min(fit.rank for fit in everyone),
        sides[0].bases[0].size,
        max(fit.condition for fit in everyone),
        errors.refusal(tolerance),
    )


def side_of(fits: list[MatchingFit]) -> SideFit:
    """Take the flows of one side as bases and coefficients."""
    orbits = tuple(Orbit(fit.flow.A, fit.flow.z0) for fit in fits)
    return SideFit(orbits, np.array([fit.flow.C.T for fit in fits]))


def _places(lines: BladeLines, side: str) -> Vector:
    """Parameters at which all sections are taken, as dense as their points."""
    return shared_parameters(lines.parameters("suction" if side == "suction" else "pressure"), 1)


def _side(points: Lines, t: Vector, model: MatchedModel, scheme: Scheme) -> list[MatchingFit]:
    return [identify(row, np.diff(t), model=model, scheme=scheme) for row in points]


def _finite(side: SideFit, name: str, model: str, lines: BladeLines) -> None:
    t = np.linspace(0.0, 1.0, 101)
    wild = ~np.isfinite(side(t)).all(axis=(1, 2))
    if wild.any():
        raise FitError(
            f'section "{lines.names[int(wild.argmax())]}", {name} side: the flow of the {model} '
            "model diverges; it cannot follow a rounded edge. Use --model modal"
        )
