"""A scan let down onto the nominal itself: robust Gauss-Newton on the distance to its feet."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from bladecad.arrays import Array, Mask, Points, Vector, seal
from bladecad.deviation.nearest.nominal import Nominal
from bladecad.deviation.nearest.project import project
from bladecad.deviation.registering.pose import coordinates, moved, pose, stepped, unit_motions
from bladecad.errors import DataError

CAUCHY: Final = 2.385  # standard deviations: 95 % efficient where the noise is Gaussian
GATE = 0.05  # of the chord: points further off are no part of the blade
ROUNDING = 1e-9  # of the chord: the least scale, of points without any noise
LEAST = 12  # points to solve for six unknowns
INNER = 30  # weightings between two projections
SETTLED = 1e-4  # of the scale: a change at which the weights have settled
STIFF = 1e-4  # of the stiffest direction: softer ones are not followed
SIZINGS = 6  # steps in which the size settles
STILL = 1e-8  # of the chord: a step at which the pose stands still
NOISE = 0.01  # of its own standard deviation: so does one at such a step


@final
@dataclass(frozen=True, eq=False)
class Frame:
    """What motions are measured by.

    centre : (3,) float, mm, in the frame of the nominal, about which it turns
    reach  : mm that a radian is worth
    chord  : mm
    free   : (6,) bool, coordinates of the pose that may change
    """

    centre: Vector
    reach: float
    chord: float
    free: Mask

    def __post_init__(self) -> None:
        seal(self, centre=(3,))


@final
@dataclass(frozen=True, eq=False)
class Met:
    """Points that stand on the nominal, and how their distances change with a motion.

    d        : (j,) float, mm
    J        : (j, 6) float, by shift (mm) and rotation (rad) about the centre of the frame
    growth   : (j,) float, mm, by growing about it to twice the size
    suction  : share of them on the suction side
    span     : (2,) float, least and largest u of all but a hundredth at each end
    rim, far : points beyond the span, and others further off than `GATE`: they are left out
    """

    d: Vector
    J: Array
    growth: Vector
    suction: float
    span: Vector
    rim: int
    far: int


@final
@dataclass(frozen=True, eq=False)
class Aligned:
    """A pose, and how the points lie on the nominal in it.

    T          : (4, 4) float
    covariance : (6, 6) float, of shift (mm) at the centre and rotation (rad), from the noise
    stiffness  : (f,) float, rising: root mean square change of the distances by a motion of 1 mm
    slack      : (6,) float, shift and rotation of the least stiff motion
    residual   : (j,) float, mm, distances of the points that were used
    scale      : their robust standard deviation, mm
    met        : their feet, before the last step
    rounds     : projections and steps made
    """

    T: Array
    covariance: Array
    stiffness: Vector
    slack: Vector
    residual: Vector
    scale: float
    met: Met
    rounds: int

    def __post_init__(self) -> None:
        seal(self, T=(4, 4), covariance=(6, 6), slack=(6,))

    @property
    def rms(self) -> float:
        """Root mean square of the residuals, mm."""
        return float(np.sqrt(np.mean(self.residual**2)))

    def cost(self, frame: Frame) -> float:
        """Mean distance of the points, mm; those too far off count as `GATE`."""
        lost = GATE * frame.chord * self.met.far
        return (float(np.abs(self.residual).sum()) + lost) / (self.met.far + len(self.residual))


def align(
    nominal: Nominal, points: Points, T: Array, frame: Frame, *, rounds: int, enough: float = 0.0
) -> Aligned:
    """Renew the feet and solve for the pose, until it stands still.

    Minimises sum_i rho(d_i / s), rho Cauchy's, d_i the distance to the blade and s its robust
    scale, over the free coordinates of T.

    Parameters
    ----------
    nominal : Nominal
    points : (k, 3) float, mm, in the frame of the scan
    T : (4, 4) float
        Where to begin, within some hundredths of the chord.
    frame : Frame
    rounds : int
        Projections at most.
    enough : float
        A step, mm, after which the feet need not be renewed.

    Raises
    ------
    DataError
        If hardly any point lies on the blade.

    Notes
    -----
    A point whose foot lies on the rim has no distance along a normal: it neither pulls nor counts.
    Nor does one further off than `GATE`: root, platform, fixture. Between two projections the
    distance is linear in the step, d + A q, and the weights are iterated on that.

    The covariance is H^-1 (sum psi^2 a a^T) H^-1 with H = sum psi' a a^T (Huber and Ronchetti,
    Robust Statistics, section 7.6): that of errors independent from point to point.
    """
    for done in range(1, rounds + 1):  # noqa: B007
        met = meet(nominal, points, T, frame)
        U, R = unit_motions(T, frame.centre, frame.reach, frame.free)
        A = met.J @ U
        y, s = _solved(A, met.d, ROUNDING * frame.chord)
        T, r = stepped(T, frame.free, coordinates(R, y)), met.d + A @ y
        C = _covariance(A, r, s)
        still = max(STILL * frame.chord, NOISE * float(np.sqrt(np.trace(C))), enough)
        if np.linalg.norm(y) <= still:
            break
    stiffness, slack = _stiffness(A, r, s)
    return Aligned(T, U @ C @ U.T, stiffness, U @ slack, r, s, met, done)


def sized(nominal: Nominal, points: Points, found: Aligned, frame: Frame) -> tuple[float, Aligned]:
    """How many times as large the points lie best on the nominal, and how they lie then.

    Gauss-Newton on size and pose together, from the pose found for the size they have.
    """
    size, T = 1.0, found.T
    for _ in range(SIZINGS):
        met = meet(nominal, points * size, T, frame)
        U, R = unit_motions(T, frame.centre, frame.reach, frame.free)
        y, _ = _solved(np.column_stack([met.J @ U, met.growth]), met.d, ROUNDING * frame.chord)
        grown = float(np.clip(1.0 + y[-1], 0.9, 1.1))
        T = stepped(T, frame.free, coordinates(R, y[:-1]))
        T = pose(T[:3, :3], frame.centre + grown * (T[:3, 3] - frame.centre))
        size = size * grown
    return size, align(nominal, points * size, T, frame, rounds=SIZINGS)


def standing(nominal: Nominal, points: Points, frame: Frame) -> Aligned:
    """The points as they stand; see `align` for what counts and for errors."""
    met = meet(nominal, points, np.eye(4), frame)
    s = _scale(met.d, ROUNDING * frame.chord)
    nothing = np.zeros((6, 6))
    return Aligned(np.eye(4), nothing, np.ones(6), nothing[0], met.d, s, met, 0)


def meet(nominal: Nominal, points: Points, T: Array, frame: Frame) -> Met:
    """Feet of the points that lie on the blade at T."""
    feet = project(nominal, moved(T, points))
    far = ~feet.rim & (np.abs(feet.distance) >= GATE * frame.chord)
    lost = int(feet.rim.sum()), int(far.sum())
    feet = feet[~(far | feet.rim)]
    if len(feet.distance) < LEAST:
        raise DataError(
            f"only {len(feet.distance)} of {len(points)} points lie within "
            f"{GATE * frame.chord:.3g} mm of the nominal and inside its span, {LEAST} are needed; "
            "the scan is of another blade, in another unit, or stands too far away"
        )
    d, n = feet.distance, feet.normal
    arm = feet.foot - frame.centre
    J, growth = np.column_stack([n, np.cross(arm, n)]), np.einsum("jx,jx->j", arm, n)
    span = np.quantile(feet.u, [0.01, 0.99])
    return Met(d, J, growth, float(np.mean(feet.suction)), span, *lost)


def _solved(A: Array, d: Vector, least: float) -> tuple[Vector, float]:
    """The step y that minimises sum rho((d + A y) / s), and the scale s.

    Directions that hardly change a distance are not followed.
    """
    y: Vector = np.zeros(A.shape[1])
    for _ in range(INNER):
        r = d + A @ y
        s = _scale(r, least)
        w = 1.0 / (1.0 + (r / (CAUCHY * s)) ** 2)
        WA = A * w[:, None]
        change = np.linalg.lstsq(WA.T @ A, -WA.T @ r, rcond=STIFF**2)[0]
        y = y + change
        if np.abs(change).max() <= SETTLED * s:
            break
    return y, s


def _scale(r: Vector, least: float) -> float:
    """Standard deviation of Gaussian residuals with the same median size."""
    return max(1.4826 * float(np.median(np.abs(r))), least)


def _covariance(A: Array, r: Vector, s: float) -> Array:
    """Covariance of the step, (f, f)."""
    x = (r / (CAUCHY * s)) ** 2
    psi, slope = r / (1.0 + x), (1.0 - x) / (1.0 + x) ** 2
    P = np.linalg.pinv((A * slope[:, None]).T @ A, rcond=STIFF**2, hermitian=True)
    return np.asarray(P @ ((A * (psi**2)[:, None]).T @ A) @ P)


def _stiffness(A: Array, r: Vector, s: float) -> tuple[Vector, Vector]:
    """Root mean square change of distance by motions of 1 mm, rising; the motion of the least."""
    w = 1.0 / (1.0 + (r / (CAUCHY * s)) ** 2)
    values, vectors = np.linalg.eigh((A * w[:, None]).T @ A / w.sum())
    return np.sqrt(np.maximum(values, 0.0)), vectors[:, 0]
