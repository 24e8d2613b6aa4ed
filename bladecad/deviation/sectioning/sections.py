"""The sections of a blade, each held against its nominal."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from bladecad.arrays import Points
from bladecad.deviation.nearest.feet import Feet
from bladecad.deviation.nearest.nominal import Nominal
from bladecad.deviation.sectioning.numbers import contours, formulas, numbers, twists
from bladecad.deviation.sectioning.outlines import Formulas
from bladecad.deviation.sectioning.parameters import Number
from bladecad.deviation.sectioning.section_fit import Limits, fits_of
from bladecad.deviation.sectioning.section_result import SectionResult
from bladecad.deviation.sectioning.station import Station, stations_at
from bladecad.deviation.sectioning.trend import Trend, trend
from bladecad.tolerance import PARAMETERS, Tolerances


def section_results(
    nominal: Nominal,
    feet: Feet,
    stations: Mapping[str, float],
    tolerances: Tolerances,
    *,
    axis: int = 2,
) -> tuple[SectionResult, ...]:
    """Measure every station: the deviation along its outline, and its numbers.

    Parameters
    ----------
    feet : Feet
        Of any points; those near a station speak for it.
    stations : name and u of each
    axis : {0, 1, 2}
        Column of the machine axis.
    """
    order = sorted(stations, key=lambda name: stations[name])
    cut = stations_at(nominal.surface, {name: stations[name] for name in order}, axis)
    found = [_at(station, feet, tolerances) for station in cut]
    staggers = [next(n for n in numbers_ if n.name == "stagger") for *_, numbers_ in found]
    turned = twists(staggers, tolerances)
    limits = _limits(tolerances)
    return tuple(_result(*one, twist, limits) for one, twist in zip(found, turned, strict=True))


def _at(
    station: Station, feet: Feet, tolerances: Tolerances
) -> tuple[Formulas, Trend, list[Number]]:
    formula = formulas(station, tolerances)
    fitted = trend(station, feet)
    found = numbers(formula, fitted, tolerances)
    found += contours(formula, fitted, tolerances)
    return formula, fitted, found


def _result(
    formula: Formulas,
    fitted: Trend,
    found: list[Number],
    twist: Number,
    limits: Limits | None,
) -> SectionResult:
    station = formula.station
    flat, flat_normal = _in_chord_frame(formula)
    deviation = np.where(fitted.measured, fitted.deviation, np.nan)
    in_plane = deviation * station.stretch * station.scale
    return SectionResult(
        station.name,
        station.u,
        station.points,
        station.normal,
        flat,
        flat_normal,
        station.suction,
        station.t,
        deviation,
        np.where(fitted.measured, fitted.quantile * fitted.sigma, np.nan),
        tuple(sorted([*found, twist], key=_order)),
        fits_of(flat, flat_normal, in_plane, limits=limits),
        fitted.points,
    )


def _limits(tolerances: Tolerances) -> Limits | None:
    """What the constrained fit may move: shift and twist inside their own bands."""
    bands = tolerances.parameters
    found = Limits(bands.get("bow along"), bands.get("bow across"), bands.get("twist"))
    return None if found == Limits() else found


def _order(number: Number) -> tuple[int, float]:
    parameter, _, offset = number.name.partition(" at ")
    return [*PARAMETERS].index(parameter), float(offset.split()[0]) if offset else 0.0  # type: ignore[arg-type]


def _in_chord_frame(formula: Formulas) -> tuple[Points, Points]:
    """The outline along and across its chord, suction side up, true to scale; and its normals."""
    X = formula.station.flat
    le, _, e = formula.chord_line(X[None])
    rows = np.stack([e[0], formula.up(e)[0]])
    flat = formula.chord_scale * (X - le[0]) @ rows.T
    return flat, formula.station.flat_normal @ rows.T
