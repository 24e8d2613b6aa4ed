"""The scalar functions of a flow from edge to edge: a polynomial core and modes that decay."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import final

import numpy as np
from numpy.polynomial import legendre

from bladecad.arrays import Array, Vector, frozen, seal

CUBIC = 3  # powers of (t - knot) from here on keep x, x' and x'' continuous


@final
@dataclass(frozen=True, eq=False)
class Spectrum:
    """The linear system z' = A z that all sections of one side share, x(t) = C z(t).

    degree  : degree p of the core, a polynomial block; A differentiates Legendre's polynomials
    le, te  : (m, 2) float; rate a and stiffness k of each pair of edge modes,
              y'' = -2 a y' - a^2 (1 + k) y, decaying away from t = 0 (le) and from t = 1 (te)
    knots   : (q,) float; places inside (0, 1) where the core is restarted with x, x', x'' continuous

    State order: core, LE pairs, TE pairs, then the restarts. t runs from 0 (LE) to 1 (TE).
    """

    degree: int
    le: Array
    te: Array
    knots: Vector = field(default_factory=lambda: np.empty(0))

    def __post_init__(self) -> None:
        seal(self, le=(None, 2), te=(None, 2), knots=(None,))

    @property
    def size(self) -> int:
        """Number n of states, and of coefficients a section and coordinate."""
        powers = max(self.degree - CUBIC + 1, 0)
        return self.degree + 1 + 2 * (len(self.le) + len(self.te)) + len(self.knots) * powers

    @cached_property
    def A(self) -> Array:
        """(n, n) float: the system matrix between knots, block diagonal."""
        n, p = self.size, self.degree + 1
        A = np.zeros((n, n))
        for j in range(p):
            A[j, :j] = 2.0 * legendre.legder(np.eye(p)[j])[:j] if j else 0.0
        for i, (a, k) in enumerate(self.le):
            A[p + 2 * i : p + 2 * i + 2, p + 2 * i : p + 2 * i + 2] = pair_matrix(a, k)
        p += 2 * len(self.le)
        for i, (a, k) in enumerate(self.te):
            A[p + 2 * i : p + 2 * i + 2, p + 2 * i : p + 2 * i + 2] = -pair_matrix(a, k)
        return frozen(A)

    def __call__(self, t: Vector, order: int = 0) -> Array:
        """State z(t), or its derivative of any order, (k, n): each family from its own end."""
        t = np.asarray(t, dtype=np.float64)
        core = legendre.legvander(2.0 * t - 1.0, self.degree)
        for _ in range(order):
            core = core @ self.A[: self.degree + 1, : self.degree + 1].T
        modes = [pair(a, k, t, order) for a, k in self.le]
        modes += [pair(a, k, 1.0 - t, order) * (-1.0) ** order for a, k in self.te]
        return np.concatenate([core, *modes, self._restarts(t, order)], axis=1)

    def _restarts(self, t: Vector, order: int) -> Array:
        """Truncated powers ((t - knot)_+)^j / (1 - knot)^j, j = 3 .. p, scaled to 1 at t = 1."""
        j = np.arange(CUBIC, self.degree + 1)
        ahead = np.maximum(t[:, None] - self.knots, 0.0)[:, :, None]
        width = (1.0 - self.knots)[:, None]
        falling = np.prod([np.maximum(j - i, 0) for i in range(order)], axis=0) if order else 1.0
        powers = np.where(ahead > 0, ahead / width, 0.0) ** np.maximum(j - order, 0)
        inside = (ahead > 0) | ((j <= order) & (ahead == 0) & (t[:, None, None] >= 1.0))
        return np.asarray(powers * falling / width**order * inside).reshape(len(t), -1)


def pair_matrix(a: float, k: float) -> Array:
    """Matrix of w' = a [[-1, -k], [1, -1]] w, whose second state obeys y'' = -2ay' - a^2(1+k)y."""
    return a * np.array([[-1.0, -k], [1.0, -1.0]])


def pair(a: float, k: float, t: Vector, order: int = 0) -> Array:
    """The pair of modes that starts as (1, 0) at t = 0, or its derivative, (len(t), 2).

    exp(-at) (cos wt', sin wt' / w) with t' = at and w = sqrt(k); for k < 0 two real rates.
    """
    w = np.stack(decay(a * t, k), axis=-1)
    return np.asarray(w @ np.linalg.matrix_power(pair_matrix(a, k), order).T)


def decay(tau: Vector, k: float) -> tuple[Vector, Vector]:
    """exp(-tau) times cos(w tau) and sin(w tau)/w, w = sqrt(k), continued to k <= 0."""
    if k > 0:
        w = np.sqrt(k)
        return np.exp(-tau) * np.cos(w * tau), np.exp(-tau) * np.sin(w * tau) / w
    m = np.sqrt(-k)
    slow = np.exp(-(1.0 - m) * tau)
    fast = np.exp(-(1.0 + m) * tau)
    return 0.5 * (slow + fast), -0.5 * slow * np.expm1(-2.0 * m * tau) / m if m else slow * tau
