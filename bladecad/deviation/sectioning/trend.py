"""Deviation round a section as one smooth curve, with what the points leave uncertain."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final, final

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtrit

from bladecad.arrays import Array, Mask, Vector, seal
from bladecad.deviation.nearest.feet import FACES, Feet
from bladecad.deviation.sectioning.knots import Round, reached, supported, wished
from bladecad.deviation.sectioning.station import Station

NEAR: Final = 0.025  # of the span: points further from a station do not speak for it
MANY: Final = (1500, 2500)  # points that speak for a station: the nearest at edges, and elsewhere
BESIDE_EDGE: Final = 0.03  # of the side
SLOPES: Final = 4  # knots of the curve for one of its slope along the span
LEVEL: Final = 1e-6  # of the span: points on one line tell no slope
OUTLIER: Final = 5.0  # sigma
CAUCHY: Final = 2.385  # sigma, of weights that keep 95 % of what the points tell
ROUNDS: Final = 5  # of such weights
FLOOR: Final = 5e-3  # mm, never an outlier
FEW: Final = 0.02  # share of the points: more are no outliers, but a shape the curve cannot follow
ROUNDING: Final = 1e-12
EDGE_FACES: Final = (FACES.index("LEADING_EDGE"), FACES.index("TRAILING_EDGE"))


@final
@dataclass(frozen=True, eq=False)
class Trend:
    """The deviation of a section, d(s) = sum_j c_j B_j(s), and of its cut-off edges, constant.

    round        : the splines B_j, or None where there were too few points
    coefficients : (q,) float, mm; those of the splines, then of the faces at LE and TE
    covariance   : (q, q) float, mm^2
    rows         : (n, q) float, the deviation at the points of the station's outline as linear
                   forms of the coefficients
    freedom      : degrees of freedom that the noise was estimated with
    noise        : mm, standard deviation of the points about the curve
    measured     : (n,) bool, points of the station's outline with measured points about them
    faces        : whether the face at LE and TE has measured points; True for round edges
    points       : how many measured points speak for it
    """

    round: Round | None
    coefficients: Vector
    covariance: Array
    rows: Array
    freedom: int
    noise: float
    measured: Mask
    faces: tuple[bool, bool]
    points: int

    def __post_init__(self) -> None:
        q = len(self.coefficients)
        seal(self, coefficients=(q,), covariance=(q, q), rows=(len(self.measured), q))

    @cached_property
    def quantile(self) -> float:
        """Half width of the 95 % interval over the standard deviation, by Student's t."""
        return float(stdtrit(max(self.freedom, 1), 0.975))

    @cached_property
    def deviation(self) -> Vector:
        """d at the points of the outline, (n,), mm, also where it is not measured."""
        return np.asarray(self.rows @ self.coefficients)

    @cached_property
    def sigma(self) -> Vector:
        """Standard deviation of d at the points of the outline, (n,), mm."""
        variance = np.einsum("ij,ij->i", self.rows @ self.covariance, self.rows)
        return np.asarray(np.sqrt(np.maximum(variance, 0.0)))


def trend(station: Station, feet: Feet) -> Trend:
    """Fit the deviation of the points near a station by least squares.

    Parameters
    ----------
    feet : Feet
        Of any points; those beyond the span are left out.

    Notes
    -----
    Minimises sum_i (d_i - d(s_i) - v_i e(s_i))^2, v = u - u0 and e(s) a coarser curve, so that a
    slope along the span does not become scatter. A point further off than five sigma is dropped if
    few are. Covariance is sigma^2 (A^T A)^-1, sigma^2 = |r|^2 / (k - q); where neighbouring
    residuals are alike, (1 + rho) / (1 - rho) times that, as of a first-order series.
    """
    near = _near(station, feet)
    on_face = np.isin(feet.face[near], EDGE_FACES)
    side, face = near[~on_face], near[on_face]
    arc = station.arc_of(feet.suction[side], feet.t[side])
    sides = wished(station, len(side))
    splines = supported(sides, arc, open_te=station.te == "blunt", closed=station.le != "blunt")
    if splines is None:
        return _nothing(station, len(near))
    A, d = splines(arc), feet.distance[side]
    v = feet.u[side] - station.u
    level = float(np.abs(v).max()) < LEVEL
    slope = A[:, :0] if level else _slopes(A) * (v / np.abs(v).max())[:, None]
    q = A.shape[1]
    fitted, r, kept, G = _fitted(np.hstack([A, slope]), d)
    freedom = int(kept.sum()) - G.shape[0]
    if freedom < 1:
        return _nothing(station, len(near))
    noise = float(np.sqrt(np.sum(r[kept] ** 2) / freedom))
    C = noise**2 * _alike(arc[kept], r[kept]) * G[:q, :q]
    means, errors, has = _faces(station, feet[face], noise)
    cov = np.zeros((q + 2, q + 2))
    cov[:q, :q], cov[q, q], cov[q + 1, q + 1] = C, errors[0] ** 2, errors[1] ** 2
    return Trend(
        splines,
        np.concatenate([fitted[:q], means]),
        cov,
        np.pad(splines(station.arc), ((0, 0), (0, 2))),
        freedom,
        noise,
        reached(sides, arc, station.arc),
        has,
        len(near),
    )


def _near(station: Station, feet: Feet) -> NDArray[np.intp]:
    """Numbers of the points that speak for a station."""
    away = np.abs(feet.u - station.u)
    found = np.flatnonzero((away < NEAR) & ~feet.rim)
    t = feet.t[found]
    edge = (t < BESIDE_EDGE) | (t > 1.0 - BESIDE_EDGE)
    parts = [found[edge], found[~edge]]
    return np.concatenate(
        [_nearest(part, away[part], most) for part, most in zip(parts, MANY, strict=True)]
    )


def _nearest(found: NDArray[np.intp], away: Vector, most: int) -> NDArray[np.intp]:
    return found if len(found) <= most else found[np.argpartition(away, most)[:most]]


def _slopes(A: Array) -> Array:
    """A coarser curve: sums of neighbouring splines."""
    return np.add.reduceat(A, np.arange(0, A.shape[1], SLOPES), axis=1)


def _fitted(A: Array, d: Vector) -> tuple[Vector, Vector, Mask, Array]:
    """Coefficients, residuals, which points were kept, and (A^T A)^-1."""
    kept = np.ones(len(d), bool)
    c, r, G = _least_squares(A, d, kept)
    bound = max(OUTLIER * _sigma(r, A.shape[1]), FLOOR)
    if np.abs(r).max() <= bound:
        return c, r, kept, G
    for _ in range(ROUNDS):
        scale = max(CAUCHY * _sigma(r, A.shape[1]), FLOOR / OUTLIER)
        r = _least_squares(A, d, 1.0 / (1.0 + (r / scale) ** 2))[1]
    good = np.abs(r) <= max(OUTLIER * _sigma(r, A.shape[1]), FLOOR)
    kept = good if good.mean() >= 1.0 - FEW else kept
    c, r, G = _least_squares(A, d, kept)
    return c, r, kept, G


def _sigma(r: Vector, coefficients: int) -> float:
    """Standard deviation of points about a curve, whatever a few of them do."""
    freedom = max(len(r) - coefficients, 1)
    return float(1.4826 * np.median(np.abs(r)) * np.sqrt(len(r) / freedom))


def _least_squares(A: Array, d: Vector, w: Vector | Mask) -> tuple[Vector, Vector, Array]:
    """Coefficients, residuals, and (A^T W A)^-1."""
    weighted = A * w[:, None]
    normal = weighted.T @ A
    normal += ROUNDING * np.trace(normal) / len(normal) * np.eye(len(normal))
    G = np.linalg.inv(normal)
    c = G @ (weighted.T @ d)
    return c, d - A @ c, np.asarray(G)


def _alike(arc: Vector, r: Vector) -> float:
    """How much neighbouring residuals that are alike take from what the points tell, >= 1."""
    r = r[np.argsort(arc, kind="stable")]
    power = float(r @ r)
    rho = float(r[1:] @ r[:-1]) / power if power > 0 else 0.0
    return (1.0 + rho) / (1.0 - rho) if rho > 2.0 / np.sqrt(len(r)) else 1.0


def _faces(
    station: Station, feet: Feet, noise: float
) -> tuple[list[float], list[float], tuple[bool, bool]]:
    """Mean deviation of the faces at LE and TE, its standard error, and whether it is known."""
    means, errors, has = [0.0, 0.0], [0.0, 0.0], [True, True]
    for k, kind in enumerate((station.le, station.te)):
        if kind == "blunt":
            d = feet.distance[feet.face == EDGE_FACES[k]]
            has[k] = len(d) > 0
            means[k] = float(np.median(d)) if len(d) else 0.0
            errors[k] = max(noise, float(np.std(d))) / np.sqrt(len(d)) if len(d) else 0.0
    return means, errors, (has[0], has[1])


def _nothing(station: Station, points: int) -> Trend:
    n = len(station.t)
    return Trend(
        None, np.zeros(0), np.zeros((0, 0)), np.zeros((n, 0)), 0, 0.0,
        np.zeros(n, bool), (False, False), points,
    )  # fmt: skip
