"""The numbers of a section with their uncertainty, from the deviation fitted to it."""

from __future__ import annotations

from typing import Final, cast

import numpy as np
from scipy.special import stdtrit

from bladecad.arrays import Array, Mask
from bladecad.deviation.sectioning.loops import Indices
from bladecad.deviation.sectioning.moved import movement
from bladecad.deviation.sectioning.outlines import EVERY, Formulas
from bladecad.deviation.sectioning.parameters import Number
from bladecad.deviation.sectioning.station import SAMPLES, Station
from bladecad.deviation.sectioning.trend import Trend
from bladecad.tolerance import Band, ParameterName, Tolerances, unit_of

STEP: Final = 1e-4  # mm of a coefficient, for the slope of a number
MOST: Final = 0.9  # share of the stretch a number is measured on that must have points
WHOLE: Final = 0.8  # of the loop, for numbers that all of it makes
NORMAL: Final = 1.96
BESIDE: Final = (0.6, 1.4)  # of an offset: where the thickness there is measured


def formulas(station: Station, tolerances: Tolerances) -> Formulas:
    """Return the numbers of a section as functions of its outline."""
    return Formulas(station, tolerances.le_offsets, tolerances.te_offsets)


def numbers(formula: Formulas, trend: Trend, tolerances: Tolerances) -> list[Number]:
    """Tell every number of a section but its twist: nominal, actual, 95 % interval.

    Parameters
    ----------
    formula : Formulas
    trend : Trend
        The deviation of the section and its covariance.

    Notes
    -----
    By linearisation: a number f of the coefficients c has the variance g^T cov(c) g, g = df/dc.
    Stretches without points keep what the smooth curve says and add, as a 95 % half width, what f
    would change if the largest deviation of the section stood in the middle of each. A number that
    is measured mainly there is left out.
    """
    if trend.round is None:
        nominal = formula(formula.station.flat[None])
        reason = f"{trend.points} points speak for this section, too few for its outline"
        return [
            _number(name, float(f[0]), None, 0.0, tolerances, reason) for name, f in nominal.items()
        ]
    move = movement(formula.station, trend)
    values = formula(move.outlines(trend.coefficients, STEP))
    q = len(trend.coefficients)
    seen = np.abs(trend.deviation[trend.measured])
    bulge = max(float(seen.max(initial=0.0)), NORMAL * trend.noise)
    found = []
    for name, f in values.items():
        slope = (f[2:] - f[1]) / STEP
        variance = float(slope[:q] @ trend.covariance @ slope[:q])
        half = np.hypot(trend.quantile * np.sqrt(variance), bulge * np.linalg.norm(slope[q:]))
        reason = _missing(name, formula, trend)
        if not (np.isfinite(f).all() and np.isfinite(half)):
            reason, half = reason or "the measured outline is too far from the nominal for it", 0.0
        actual = None if reason else float(f[1])
        found.append(_number(name, float(f[0]), actual, float(half), tolerances, reason))
    return found


def contours(formula: Formulas, trend: Trend, tolerances: Tolerances) -> list[Number]:
    """Tell the least and the largest deviation of edges, concave and convex side.

    The interval holds wherever on the stretch the largest stands: it is that of all coefficients
    that act there at once (Bonferroni).
    """
    found = []
    for region, where in _regions(formula.station, tolerances).items():
        d, half, share = _on(trend, formula.station, where)
        reason = "" if share >= MOST else f"{100 * share:.0f} % of it is measured"
        for kind, pick in (("min", np.argmin), ("max", np.argmax)):
            name = f"{region} contour {kind}"
            actual = None if reason else float(d[pick(d)])
            found.append(_number(name, 0.0, actual, half, tolerances, reason))
    return found


def twists(staggers: list[Number], tolerances: Tolerances) -> list[Number]:
    """Tell the stagger of every section less that of the lowest one that is known."""
    known = [s for s in staggers if s.actual is not None]
    if not known:
        return [_number("twist", None, None, 0.0, tolerances, s.reason) for s in staggers]
    hub = known[0]
    return [_twist(s, hub, tolerances) for s in staggers]


def _twist(stagger: Number, hub: Number, tolerances: Tolerances) -> Number:
    assert stagger.nominal is not None
    assert hub.nominal is not None
    assert hub.actual is not None
    nominal = stagger.nominal - hub.nominal
    if stagger.actual is None:
        return _number("twist", nominal, None, 0.0, tolerances, stagger.reason)
    if stagger is hub:
        return _number("twist", 0.0, 0.0, 0.0, tolerances, "")
    half = np.hypot(stagger.uncertainty or 0.0, hub.uncertainty or 0.0)
    return _number("twist", nominal, stagger.actual - hub.actual, float(half), tolerances, "")


def _number(
    name: str,
    nominal: float | None,
    actual: float | None,
    half: float,
    tolerances: Tolerances,
    reason: str,
) -> Number:
    parameter = cast(ParameterName, name.split(" at ")[0])
    band: Band | None = tolerances.parameters.get(parameter)
    uncertainty = None if actual is None else half
    return Number(name, unit_of(parameter), nominal, actual, uncertainty, band, reason)


def _regions(station: Station, tolerances: Tolerances) -> dict[str, Mask]:
    t, suction = station.t, station.suction
    le, te = t < tolerances.le_zone, t > 1.0 - tolerances.te_zone
    found = {"leading edge": le, "trailing edge": te}
    found |= {"concave": ~suction & ~le & ~te, "convex": suction & ~le & ~te}
    return {name: where for name, where in found.items() if where.any()}


def _on(trend: Trend, station: Station, where: Mask) -> tuple[Array, float, float]:
    """Deviation on a stretch, half width of its simultaneous interval, share that is measured."""
    share = float(np.average(trend.measured[where], weights=station.lengths[where]))
    there = where & trend.measured
    if trend.round is None or not there.any():
        return np.zeros(0), 0.0, 0.0
    acting = int(np.count_nonzero(np.abs(trend.rows[there]).max(axis=0) > 0))
    quantile = stdtrit(max(trend.freedom, 1), 1.0 - 0.025 / acting)
    return trend.deviation[there], float(quantile * trend.sigma[there].max()), share


def _missing(name: str, formula: Formulas, trend: Trend) -> str:
    """Why the points do not tell a number, or ""."""
    where, least = _needs(name, formula)
    weight = formula.station.lengths
    shares = [np.average(trend.measured[part], weights=weight[part]) for part in where]
    share = float(np.min(shares))
    if share < least:
        return f"{100 * share:.0f} % of the outline that makes it is measured"
    ends = {"leading": (True, False), "trailing": (False, True)}.get(name.split()[0], (True, True))
    if any(need and not has for need, has in zip(ends, trend.faces, strict=True)):
        return "the face of the cut-off edge is not measured"
    return ""


def _needs(name: str, formula: Formulas) -> tuple[list[Indices], float]:
    """Stretches of the outline that a number is measured on, and the least share with points."""
    le = formula.le_nose if formula.le_nose is not None else formula.le_ring
    te = formula.te_nose if formula.te_nose is not None else formula.te_ring
    if name.startswith("bow"):
        return [np.arange(len(formula.station.t))], WHOLE
    if name == "camber":
        return [le, te, np.arange(SAMPLES), formula.station.side("pressure")], WHOLE
    if name == "maximum thickness":
        return _thickest(formula), MOST
    if name == "maximum thickness place":
        return [le, *_thickest(formula)], MOST
    if name.endswith("edge radius"):
        return [le if name.startswith("leading") else te], MOST
    if " at " in name:
        offset = float(name.split()[-2])
        return _beside(formula.station, offset, name.startswith("trailing")), MOST
    return [le, te], MOST


def _thickest(formula: Formulas) -> list[Indices]:
    """Stretches that the largest circle touches."""
    r, _ = formula.inscribed(formula.station.flat[None])
    k = int(r[0].argmax())
    i = int(formula.touching[k])
    return [np.arange(i - EVERY, i + EVERY + 1), formula.partners[k]]


def _beside(station: Station, offset: float, from_te: bool) -> list[Indices]:
    """Stretches of both sides about an offset from an edge."""
    found = []
    for name in ("suction", "pressure"):
        side = station.side(name)[:: -1 if from_te else 1]
        steps = np.linalg.norm(np.diff(station.points[side], axis=0), axis=1)
        away = np.concatenate([[0.0], np.cumsum(steps)])
        near = (away > BESIDE[0] * offset) & (away < BESIDE[1] * offset)
        found.append(side[near] if near.any() else side[:2])
    return found
