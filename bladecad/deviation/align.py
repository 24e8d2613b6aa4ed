"""A scan let down onto the nominal itself: robust Gauss-Newton on the distance to its feet."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from scipy.linalg import eigh

from bladecad.arrays import Array, Mask, Points, Vector, seal
from bladecad.deviation.nominal import Nominal
from bladecad.deviation.pose import motions, moved, stepped
from bladecad.deviation.project import project
from bladecad.errors import DataError

CAUCHY: Final = 2.385  # standard deviations: 95 % efficient where the noise is Gaussian
GATE = 0.05  # of the chord: points further off are no part of the blade
ROUNDING = 1e-9  # of the chord: the least scale, of points without any noise
LEAST = 12  # points to solve for six unknowns
INNER = 30  # weightings between two projections
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

    @property
    def worth(self) -> Vector:
        """Millimetres that a unit of shift or rotation is worth, (6,)."""
        return np.repeat([1.0, self.reach], 3)


@final
@dataclass(frozen=True, eq=False)
class Met:
    """Points that stand on the nominal, and how their distances change with a motion.

    d        : (j,) float, mm
    J        : (j, 6) float, by shift (mm) and rotation (rad) about the centre of the frame
    suction  : share of them on the suction side
    span     : (2,) float, least and largest u of all but a hundredth at each end
    rim, far : points beyond the span, and others further off than `GATE`: they are left out
    """

    d: Vector
    J: Array
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
        B = motions(T, frame.centre, frame.free)
        A = met.J @ B
        q, s = _solved(A, met.d, ROUNDING * frame.chord)
        T, step, r = stepped(T, frame.free, q), B @ q, met.d + A @ q
        C = B @ _covariance(A, r, s) @ B.T
        noise = np.sqrt(frame.worth**2 @ np.diag(C))
        still = max(STILL * frame.chord, NOISE * float(noise), enough)
        if np.linalg.norm(frame.worth * step) <= still:
            break
    stiffness, slack = _stiffness(met.J, r, s, B, frame)
    return Aligned(T, C, stiffness, slack, r, s, met, done)


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
    J = np.column_stack([n, np.cross(feet.foot - frame.centre, n)])
    span = np.quantile(feet.u, [0.01, 0.99])
    return Met(d, J, float(np.mean(feet.suction)), span, *lost)


def _solved(A: Array, d: Vector, least: float) -> tuple[Vector, float]:
    """The step q that minimises sum rho((d + A q) / s), and the scale s."""
    size = _size(A)
    A = A / size
    q = np.zeros(A.shape[1])
    for _ in range(INNER):
        r = d + A @ q
        s = _scale(r, least)
        w = 1.0 / (1.0 + (r / (CAUCHY * s)) ** 2)
        change = np.linalg.lstsq((A * w[:, None]).T @ A, -(A * w[:, None]).T @ r, rcond=1e-14)[0]
        q = q + change
        if np.abs(change).max() <= 1e-4 * s:
            break
    return np.asarray(q / size), s


def _size(A: Array) -> Vector:
    """Lengths of the columns."""
    return np.asarray(np.sqrt(np.maximum(np.einsum("ki,ki->i", A, A), 1e-300)))


def _scale(r: Vector, least: float) -> float:
    """Standard deviation of Gaussian residuals with the same median size."""
    return max(1.4826 * float(np.median(np.abs(r))), least)


def _covariance(A: Array, r: Vector, s: float) -> Array:
    """Covariance of the free coordinates, (f, f)."""
    x = (r / (CAUCHY * s)) ** 2
    psi, slope = r / (1.0 + x), (1.0 - x) / (1.0 + x) ** 2
    size = _size(A)
    A = A / size
    P = np.linalg.pinv((A * slope[:, None]).T @ A, hermitian=True)
    C = P @ ((A * (psi**2)[:, None]).T @ A) @ P
    return np.asarray(C / np.outer(size, size))


def _stiffness(J: Array, r: Vector, s: float, B: Array, frame: Frame) -> tuple[Vector, Vector]:
    """Root mean square change of distance by motions of 1 mm, and the motion of the least."""
    w = 1.0 / (1.0 + (r / (CAUCHY * s)) ** 2)
    G = B.T @ ((J * w[:, None]).T @ J / w.sum()) @ B
    values, vectors = eigh(G, B.T @ (frame.worth[:, None] ** 2 * B))
    return np.sqrt(np.maximum(values, 0.0)), B @ vectors[:, 0]
