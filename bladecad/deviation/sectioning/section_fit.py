"""Fits of one section in its plane, as inspection rooms make them."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import dataclass
from typing import Literal, final, get_args

import numpy as np
from scipy.optimize import linprog, lsq_linear

from bladecad.arrays import Array, Mask, Vector, seal
from bladecad.deviation.sectioning.gaps import seal_gaps
from bladecad.deviation.sectioning.outline_curve import OutlineCurve
from bladecad.errors import DataError, GeometryError, ToleranceError
from bladecad.tolerance import Band

Kind = Literal["least squares", "min-max", "leading edge", "trailing edge", "constrained"]
Range = tuple[float, float, float]

ZONE = 0.1  # of the chord: what an edge fit looks at
LEAST = 6  # points, for three unknowns
STEPS, HALVINGS = 40, 12
STILL = 1e-10  # of the chord


@final
@dataclass(frozen=True)
class Limits:
    """What a constrained fit may move; None where it is free.

    along, across : mm, along the chord and across it
    twist         : degrees, from along towards across
    """

    along: Band | None = None
    across: Band | None = None
    twist: Band | None = None


@final
@dataclass(frozen=True, eq=False)
class SectionFit:
    """How a measured section stands on the nominal one, and what is left without that.

    kind     : of fit
    shift    : (2,) float, mm, of the metal at `centre`, along the chord and across it
    twist    : rad, of the metal, from along towards across
    centre   : (2,) float, mm, about which it is twisted: centre of the outline
    before, after : least, largest and root mean square deviation of the points fitted, mm; every
               point weighs as the length of outline it stands for
    residual : (n,) float, mm, of all points; NaN where not measured
    fitted   : how many points were fitted
    """

    kind: Kind
    shift: Vector
    twist: float
    centre: Vector
    before: Range
    after: Range
    residual: Vector
    fitted: int

    def __post_init__(self) -> None:
        seal(self, shift=(2,), centre=(2,))
        seal_gaps(self, residual=(len(self.residual),))


def fit_section(
    outline: Array,
    normals: Array,
    deviation: Vector,
    *,
    kind: Kind = "least squares",
    zone: float = ZONE,
    limits: Limits | None = None,
) -> SectionFit:
    """Find the shift and twist of a section in its plane.

    "least squares" minimises the integral of r^2 along the outline, "min-max" the largest |r|
    (Chebyshev); "leading edge" and "trailing edge" are least squares over the zone at that edge;
    "constrained" is least squares with shift and twist inside their limits.

    Parameters
    ----------
    outline, normals : (n, 2) float, mm and unit vectors out of the metal
        The nominal section as a loop in order, no point repeated, in a plane whose first axis runs
        along the chord from leading to trailing edge, and whose second runs across it.
    deviation : (n,) float, mm
        Along the normals, positive outside the metal; NaN where not measured.
    kind : see above
    zone : float
        Share of the chord that an edge fit looks at.
    limits : Limits, optional
        Of "constrained", which needs it.

    Raises
    ------
    DataError
        If fewer than six points are measured where the fit looks.
    ToleranceError
        If limits are missing.

    Notes
    -----
    The measured points are p + d n; r is their distance from the nominal outline once shift and
    twist are taken out, with new feet after every step, so that the motion need not be small
    against the radius of the edges. Each step solves the linear problem: by lstsq, as a linear
    programme, or by lsq_linear.
    """
    d, bounds = np.asarray(deviation, dtype=np.float64), _bounds(kind, limits)
    curve = OutlineCurve(outline, normals)
    used = np.isfinite(d) & _looked_at(curve.points, kind, zone)
    if used.sum() < LEAST:
        raise DataError(
            f"{used.sum()} points of the section are measured where the {kind} fit looks, {LEAST} "
            "are needed; scan it more densely, or look at a larger zone"
        )
    centre = np.average(curve.points, axis=0, weights=curve.length)
    metal = curve.points + np.nan_to_num(d)[:, None] * curve.normals - centre
    weight = curve.length[used] / curve.length[used].sum()
    g = _fitted(curve, metal[used], centre, weight, kind, bounds)
    r = _left(curve, metal, centre, g)[0]
    after = _range(r[used], weight)
    r = np.where(np.isfinite(d), r, np.nan)
    before = _range(d[used], weight)
    return SectionFit(kind, g[:2], float(g[2]), centre, before, after, r, int(used.sum()))


def fits_of(
    outline: Array,
    normals: Array,
    deviation: Vector,
    *,
    zone: float = ZONE,
    limits: Limits | None = None,
) -> tuple[SectionFit, ...]:
    """All fits that the points of a section allow; see `fit_section`."""
    found = []
    for kind in get_args(Kind):
        if kind != "constrained" or limits is not None:
            with suppress(DataError):
                fit = fit_section(outline, normals, deviation, kind=kind, zone=zone, limits=limits)
                found.append(fit)
    return tuple(found)


def _bounds(kind: Kind, limits: Limits | None) -> Array:
    """Least and largest shift along, shift across, twist; (2, 3)."""
    if kind != "constrained":
        return np.outer([-1.0, 1.0], np.full(3, np.inf))
    if limits is None:
        raise ToleranceError("a constrained fit needs limits of shift and twist; none are given")
    bands = (limits.along, limits.across, limits.twist)
    found = [(b.lower, b.upper) if b else (-np.inf, np.inf) for b in bands]
    return np.asarray(np.transpose(found) * np.array([1.0, 1.0, np.pi / 180.0]))


def _looked_at(points: Array, kind: Kind, zone: float) -> Mask:
    x = (points[:, 0] - points[:, 0].min()) / np.ptp(points[:, 0])
    if kind == "leading edge":
        return np.asarray(x <= zone)
    return np.asarray(x >= 1.0 - zone) if kind == "trailing edge" else np.ones(len(x), bool)


def _range(r: Vector, weight: Vector) -> Range:
    return float(r.min()), float(r.max()), float(np.sqrt(weight @ r**2))


def _left(curve: OutlineCurve, metal: Array, centre: Vector, g: Vector) -> tuple[Vector, Array]:
    """Distances once the motion g is taken out, and their change with g, (m,) and (m, 3)."""
    c, s = np.cos(g[2]), np.sin(g[2])
    R = np.array([[c, -s], [s, c]])
    y = (metal - g[:2]) @ R
    r, n = curve.foot(y + centre)
    across = y[:, 0] * n[:, 1] - y[:, 1] * n[:, 0]
    return r, np.column_stack([n @ R.T, across])


def _fitted(
    curve: OutlineCurve, metal: Array, centre: Vector, weight: Vector, kind: Kind, bounds: Array
) -> Vector:
    """The motion (shift, twist), by steps that never make it worse."""
    size = np.array([1.0, 1.0, 0.25 * float(np.ptp(curve.points[:, 0]))])
    badness = _largest if kind == "min-max" else _square
    g: Vector = np.zeros(3)
    r, A = _left(curve, metal, centre, g)
    for _ in range(STEPS):
        x = _step(A / size, r, weight, kind, (bounds - g) * size) / size
        for _ in range(HALVINGS):
            there = _left(curve, metal, centre, g + x)
            if badness(there[0], weight) < badness(r, weight):
                break
            x = 0.5 * x
        else:
            return g
        g, (r, A) = g + x, there
        if np.abs(x * size).max() < STILL * size[2]:
            return g
    return g


def _square(r: Vector, weight: Vector) -> float:
    return float(weight @ r**2)


def _largest(r: Vector, weight: Vector) -> float:
    return float(np.abs(r).max())


def _step(A: Array, r: Vector, weight: Vector, kind: Kind, bounds: Array) -> Vector:
    """The x that makes r - A x small."""
    if kind == "min-max":
        return _chebyshev(A, r)
    root = np.sqrt(weight)
    if kind == "constrained":
        low, high = np.minimum(bounds[0], 0.0), np.maximum(bounds[1], 0.0)
        found = lsq_linear(A * root[:, None], r * root, (low, high), tol=1e-14)
        return np.asarray(found.x, dtype=np.float64)
    return np.asarray(np.linalg.lstsq(A * root[:, None], r * root, rcond=None)[0])


def _chebyshev(A: Array, r: Vector) -> Vector:
    """Minimise z with |r - A x| <= z: a linear programme in x and z."""
    scale = max(float(np.abs(r).max()), 1e-300)
    one = np.ones((len(r), 1))
    rows = np.asarray(np.block([[-A, -one], [A, -one]]), dtype=np.float64)
    found = linprog(
        [0.0, 0.0, 0.0, 1.0],
        rows,
        np.concatenate([-r, r]) / scale,
        bounds=(None, None),
        method="highs",
    )
    if found.x is None:
        raise GeometryError(f"the min-max fit of a section failed: {found.message}")
    return np.asarray(found.x[:3] * scale)
