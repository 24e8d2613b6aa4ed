"""The scalar functions of a flow from edge to edge: a polynomial core and modes that decay."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache, cached_property, lru_cache
from typing import final

import numpy as np
from numpy.polynomial import legendre

from bladecad.arrays import Array, Vector, frozen, seal
from bladecad.splines import basis

SMOOTH = 2  # derivatives continuous where the core is restarted


@final
@dataclass(frozen=True, eq=False)
class Spectrum:
    """The linear system z' = A z that all sections of one side share, x(t) = C z(t).

    degree  : degree p of the core, a polynomial block; A differentiates Legendre's polynomials
    le, te  : (m, 2) float; rate a and stiffness k of each pair of edge modes,
              y'' = -2 a y' - a^2 (1 + k) y, decaying away from t = 0 (le) and from t = 1 (te)
    knots   : (q,) float; inside (0, 1), where the core is restarted with x, x', x'' continuous

    State order: core, LE pairs, TE pairs. t runs from 0 (LE) to 1 (TE). Without knots the core is
    Legendre's polynomials; with knots it is the B-splines on them, the same space restarted.
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
        return len(self.one)

    @cached_property
    def core(self) -> Vector:
        """Knot vector of the core: each inner knot leaves x, x' and x'' continuous."""
        ends = self.degree + 1
        repeats = max(self.degree - SMOOTH, 1)
        return np.repeat([0.0, *self.knots, 1.0], [ends, *[repeats] * len(self.knots), ends])

    @cached_property
    def one(self) -> Vector:
        """(n,) float: the coefficients of the constant 1."""
        core = np.eye(self.degree + 1)[0]
        if len(self.knots):
            core = np.ones(len(self.core) - self.degree - 1)
        return frozen(np.concatenate([core, np.zeros(2 * (len(self.le) + len(self.te)))]))

    @cached_property
    def A(self) -> Array:
        """System matrix, block diagonal; with knots, of one segment between two of them."""
        blocks = [differentiation(self.degree), *(pair_matrix(a, k) for a, k in self.le)]
        blocks += [-pair_matrix(a, k) for a, k in self.te]
        return frozen(_block_diagonal(blocks))

    def __call__(self, t: Vector, order: int = 0) -> Array:
        """State z(t), or its derivative of any order, (k, n): each family from its own end."""
        t = np.asarray(t, dtype=np.float64)
        at_le, modes = len(self.le), np.concatenate([self.le, self.te])
        w = pairs(modes, np.repeat([t, 1.0 - t], [at_le, len(self.te)], axis=0), order)
        w[at_le:] *= (-1.0) ** order
        return np.concatenate([self._core(t, order), *w], axis=1)

    def _core(self, t: Vector, order: int) -> Array:
        if len(self.knots):
            return basis(self.core, self.degree, t, order)
        polynomials = _polynomials(self.degree, t.tobytes())
        for _ in range(order):
            polynomials = polynomials @ differentiation(self.degree).T
        return polynomials


@lru_cache(maxsize=16)
def _polynomials(degree: int, t: bytes) -> Array:
    """Legendre's polynomials of 2t - 1; a search asks for the same ones at every step."""
    return frozen(legendre.legvander(2.0 * np.frombuffer(t) - 1.0, degree))


@cache
def differentiation(degree: int) -> Array:
    """Matrix of d/dt on Legendre's polynomials of 2t - 1, nilpotent."""
    p = degree + 1
    rows = [np.pad(legendre.legder(row)[:p], (0, 1))[:p] for row in np.eye(p)]
    return frozen(2.0 * np.array(rows))


def pair_matrix(a: float, k: float) -> Array:
    """Matrix of w' = a [[-1, -k], [1, -1]] w, whose second state obeys y'' = -2ay' - a^2(1+k)y."""
    return a * np.array([[-1.0, -k], [1.0, -1.0]])


def pair(a: float, k: float, t: Vector, order: int = 0) -> Array:
    """The pair of modes that starts as (1, 0) at t = 0, or its derivative, (len(t), 2).

    exp(-at) (cos wt', sin wt' / w) with t' = at and w = sqrt(k); for k < 0 two real rates.
    """
    return np.asarray(pairs(np.array([[a, k]]), t, order)[0])


def pairs(modes: Array, t: Vector, order: int = 0) -> Array:
    """Many pairs at once, a row (a, k) each, t for all or a row each too, (m, len(t), 2)."""
    a, k = modes[:, :1], modes[:, 1]
    w = np.stack(decay(a * t, k), axis=-1)
    for _ in range(order):
        w = w @ np.reshape([pair_matrix(a, k).T for a, k in modes], (-1, 2, 2))
    return np.asarray(w)


def decay(tau: Array, k: Vector) -> tuple[Array, Array]:
    """exp(-tau) times cos(w tau) and sin(w tau)/w, w = sqrt(k), continued to k <= 0; a row a k."""
    y1, y2 = np.empty_like(tau), np.empty_like(tau)
    for rows, kind in ((k > 0, _turning), (k < 0, _creeping), (k == 0, _critical)):
        if rows.any():
            y1[rows], y2[rows] = kind(tau[rows], np.sqrt(np.abs(k[rows, None])))
    return y1, y2


def _turning(tau: Array, w: Array) -> tuple[Array, Array]:
    fading = np.exp(-tau)
    return fading * np.cos(w * tau), fading * np.sin(w * tau) / w


def _creeping(tau: Array, m: Array) -> tuple[Array, Array]:
    slow, fast = np.exp(-(1.0 - m) * tau), np.exp(-(1.0 + m) * tau)
    return 0.5 * (slow + fast), -0.5 * slow * np.expm1(-2.0 * m * tau) / m


def _critical(tau: Array, _: Array) -> tuple[Array, Array]:
    slow = np.exp(-tau)
    return slow, slow * tau


def _block_diagonal(blocks: list[Array]) -> Array:
    ends = np.cumsum([0, *[len(b) for b in blocks]])
    A = np.zeros((ends[-1], ends[-1]))
    for block, first, last in zip(blocks, ends, ends[1:], strict=False):
        A[first:last, first:last] = block
    return A
