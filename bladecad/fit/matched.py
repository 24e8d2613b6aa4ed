"""The paper's own models for a whole blade: every line by itself, by matching derivatives."""

from __future__ import annotations

from typing import Literal

import numpy as np

from bladecad.arrays import Array, Lines, Points, Vector
from bladecad.curves.sides import BladeLines, Side
from bladecad.errors import FitError
from bladecad.fit.blade import BladeFit
from bladecad.fit.differences import Scheme
from bladecad.fit.judge import SIDES, Bench, judge
from bladecad.fit.matching import MatchingFit, identify
from bladecad.fit.orbit import Orbit
from bladecad.fit.samples import shared_parameters
from bladecad.fit.second_order import Ends
from bladecad.fit.sidefit import SideFit

MatchedModel = Literal["paper", "affine", "second-order"]
FURTHEST = 0.1  # of the length of a side: beyond, it is no blade any more


def fit_matched(
    lines: BladeLines, *, model: MatchedModel, tolerance: float, scheme: Scheme = "midpoint"
) -> BladeFit:
    """Fit every line of a blade by matching derivatives, eqs. (2)-(7) and their descendants.

    "second-order" is held to the first and last point of each side, so that the sides meet at both
    edges, with a corner; the others start at the leading edge and end where they end.

    Raises
    ------
    FitError
        If a flow strays from the blade by more than a tenth of its length, or leaves the floats:
        no solid can be made of it. Its `best` is the fit, where it has numbers.
    """
    sides = [
        side_of([line_flow(row, places(lines, s), model, scheme) for row in _rows(lines, s)])
        for s in SIDES
    ]
    for name, side in zip(SIDES, sides, strict=True):
        _refuse_divergence(side, name, model, lines)
    errors = judge(Bench.of(lines), sides[0], sides[1])
    size = sides[0].bases[0].size
    fit = BladeFit(
        model, None, sides[0], sides[1], lines, errors, tolerance, size, size, 1.0,
        errors.refusal(tolerance),
    )  # fmt: skip
    if errors.largest > FURTHEST * lines.lengths.max():
        side_name, i, t = errors.worst()
        raise FitError(
            f"the {model} model strays {errors.largest:.3g} mm from the {side_name} side of "
            f'section "{lines.names[i]}" at t = {t:.3f}; no solid can be made of it, '
            "use --model modal",
            best=fit,
        )
    return fit


def side_of(fits: list[MatchingFit]) -> SideFit:
    """Take the flows of one side as bases and coefficients, states filled up to one number."""
    most = max(len(fit.flow.z0) for fit in fits)
    orbits = tuple(Orbit(_filled(f.flow.A, most, most), _filled(f.flow.z0, most)) for f in fits)
    return SideFit(orbits, np.array([_filled(fit.flow.C.T, most, 3) for fit in fits]))


def _filled(values: Array, *shape: int) -> Array:
    return np.pad(values, [(0, n - k) for n, k in zip(shape, np.shape(values), strict=True)])


def places(lines: BladeLines, side: Side) -> Vector:
    """Parameters at which all sections are taken, as dense as their points."""
    return shared_parameters(lines.parameters(side), 1)


def _rows(lines: BladeLines, side: Side) -> Lines:
    return lines.sample(side, places(lines, side))


def line_flow(points: Points, t: Vector, model: MatchedModel, scheme: Scheme) -> MatchingFit:
    """Match one line; of second order it is held to the first and the last point."""
    ends = Ends(start=points[0], end=points[-1]) if model == "second-order" else None
    return identify(points, np.diff(t), model=model, scheme=scheme, ends=ends)


def _refuse_divergence(side: SideFit, name: Side, model: str, lines: BladeLines) -> None:
    wild = ~np.isfinite(side(np.linspace(0.0, 1.0, 101))).all(axis=(1, 2))
    if wild.any():
        raise FitError(
            f'section "{lines.names[int(wild.argmax())]}", {name} side: the flow of the {model} '
            "model diverges; it cannot follow a rounded edge. Use --model modal"
        )
