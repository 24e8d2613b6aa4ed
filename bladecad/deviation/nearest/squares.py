"""A skin as polynomial squares: the form in which feet are found quickly."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Vector, seal
from bladecad.errors import GeometryError

Chart = Callable[[Vector, Vector], Array]  # X on the grid u x t, (len(u), len(t), 3)

P, Q = 3, 7  # degrees in u and t: a spline law is cubic in u, the flow in t is what it is
EXACT = 1e-9  # mm, of the squares from the chart
WIDE, TURN = 0.02, 0.2  # of the size of the face, and rad: the largest square, to hold one foot
SLIGHT = 1e-2  # of the largest |X_v x X_w|; below, the normal is not looked at
ROUNDS = 16
LARGEST = 500_000  # squares


@final
@dataclass(frozen=True, eq=False)
class Squares:
    """Charts cut into squares, X(v,w) = sum_ij c_ij v^i w^j with v and w from 0 to 1.

    c      : (n, P + 1, Q + 1, 3) float, mm
    domain : (n, 4) float, u and its length, t and its length: u = u_0 + v u_1, t = t_0 + w t_1
    face   : (n,) int, number of the face it belongs to
    sign   : (n,) float, 1 where X_v x X_w points out of the metal, else -1
    error  : largest distance from the charts, measured between the nodes, mm
    """

    c: Array
    domain: Array
    face: NDArray[np.int64]
    sign: Vector
    error: float

    def __post_init__(self) -> None:
        n = len(self.c)
        seal(self, c=(n, P + 1, Q + 1, 3), domain=(n, 4), sign=(n,))


def cut(chart: Chart, u: Vector, t: Vector, *, face: int, sign: float) -> Squares:
    """Cut a chart into squares that follow it to `EXACT`.

    Each is the interpolant at Chebyshev's points, cubic in u and of degree seven in t; a step in u
    or t is cut where the interpolant strays along it, where a square is wide, and where it turns.

    Parameters
    ----------
    chart : callable
    u, t : (m,) and (n,) float
        Breaks to begin with; the chart is smooth between them.
    face, sign
        Of the squares.

    Raises
    ------
    GeometryError
        If it takes more than half a million squares.
    """
    for _ in range(ROUNDS):
        c = _interpolated(chart, u, t)
        off_u, off_t = _off(chart, c, u, t)
        parts_u, parts_t = _parts(c, off_u, off_t)
        if parts_u.max() == 1 and parts_t.max() == 1:
            domain = np.stack(
                np.broadcast_arrays(
                    u[:-1, None], np.diff(u)[:, None], t[None, :-1], np.diff(t)[None, :]
                ),
                axis=2,
            )
            n = domain.shape[0] * domain.shape[1]
            return Squares(
                c.reshape(n, P + 1, Q + 1, 3),
                domain.reshape(n, 4),
                np.full(n, face),
                np.full(n, sign),
                float(off_u.max() + off_t.max()),
            )
        u, t = _refined(u, parts_u), _refined(t, parts_t)
        if len(u) * len(t) > LARGEST:
            break
    raise GeometryError(
        f"a face of the nominal takes more than {LARGEST:,} squares to follow it to "
        f"{EXACT:g} mm; it has kinks or folds, give it as a mesh instead"
    )


def joined(parts: Sequence[Squares]) -> Squares:
    """Put the squares of several faces together."""
    return Squares(
        np.concatenate([p.c for p in parts]),
        np.concatenate([p.domain for p in parts]),
        np.concatenate([p.face for p in parts]),
        np.concatenate([p.sign for p in parts]),
        max(p.error for p in parts),
    )


def _nodes(degree: int) -> Vector:
    """Chebyshev's points of the second kind on [0, 1], ends among them."""
    return np.asarray(0.5 - 0.5 * np.cos(np.pi * np.arange(degree + 1) / degree))


def _checks(degree: int) -> Vector:
    """Places half-way between the nodes, in angle."""
    return np.asarray(0.5 - 0.5 * np.cos(np.pi * (np.arange(degree) + 0.5) / degree))


TO_U: Final = np.asarray(np.linalg.inv(np.vander(_nodes(P), increasing=True)), np.float64)
TO_T: Final = np.asarray(np.linalg.inv(np.vander(_nodes(Q), increasing=True)), np.float64)
AT_U: Final = np.vander(_checks(P), P + 1, increasing=True)
AT_T: Final = np.vander(_checks(Q), Q + 1, increasing=True)


def _spread(breaks: Vector, inner: Vector) -> Vector:
    """Places inside every step, in one row; the ends of neighbours agree to the last bit."""
    a, b = breaks[:-1, None], breaks[1:, None]
    return np.asarray(np.where(inner == 1.0, b, a + inner * (b - a))).ravel()


def _sampled(chart: Chart, u: Vector, v: Vector, t: Vector, w: Vector) -> Array:
    """X at the places v x w of every square, (m, n, len(v), len(w), 3)."""
    X = chart(_spread(u, v), _spread(t, w))
    return X.reshape(len(u) - 1, len(v), len(t) - 1, len(w), 3).transpose(0, 2, 1, 3, 4)


def _interpolated(chart: Chart, u: Vector, t: Vector) -> Array:
    X = _sampled(chart, u, _nodes(P), t, _nodes(Q))
    origin = X[:, :, 0, 0]  # taken off, lest its digits drown those of the square
    c = np.ascontiguousarray(_at(X - origin[:, :, None, None], TO_U, TO_T))
    c[:, :, 0, 0] += origin
    return c


def _off(chart: Chart, c: Array, u: Vector, t: Vector) -> tuple[Array, Array]:
    """Distance from the chart half-way between the nodes of u, and of t, (m, n) each."""
    v, w = _nodes(P), _nodes(Q)
    V, W = np.vander(v, increasing=True), np.vander(w, increasing=True)
    along_u = _sampled(chart, u, _checks(P), t, w) - _at(c, AT_U, W)
    along_t = _sampled(chart, u, v, t, _checks(Q)) - _at(c, V, AT_T)
    off_u, off_t = (_lengths(r).max(axis=(2, 3)) for r in (along_u, along_t))
    return off_u, off_t


def _at(c: Array, V: Array, W: Array) -> Array:
    """V_ai W_bj c_mnijx, (m, n, a, b, 3), one product for all."""
    m, n, i, j, x = c.shape
    found = c.transpose(0, 1, 4, 2, 3).reshape(-1, i * j) @ np.kron(V, W).T
    return found.reshape(m, n, x, len(V), len(W)).transpose(0, 1, 3, 4, 2)


def _parts(c: Array, off_u: Array, off_t: Array) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Into how many parts each step of u and t is cut."""
    need_u, need_t = (off_u / EXACT) ** (1.0 / (P + 1)), (off_t / EXACT) ** (1.0 / (Q + 1))
    if max(off_u.max(), off_t.max()) <= EXACT:  # before, the squares turn as they like
        need_u, need_t = _bends(c)
    worst_u, worst_t = need_u.max(axis=1), need_t.max(axis=0)
    parts_u, parts_t = (
        np.ceil(np.clip(worst, 1.0, 8.0) - 1e-9).astype(np.int64) for worst in (worst_u, worst_t)
    )
    return parts_u, parts_t


def _bends(c: Array) -> tuple[Array, Array]:
    """How wide each square is and how far it turns along u, and along t, 1 allowed, (m, n) each."""
    V, W = (np.vander([0.0, 0.5, 1.0], k + 1, increasing=True) for k in (P, Q))
    Vd, Wd = (np.array([[i * x ** max(i - 1, 0) for i in range(k + 1)] for x in (0.0, 0.5, 1.0)])
              for k in (P, Q))  # fmt: skip
    X = _at(c, V, W)
    N = np.cross(_at(c, Vd, W), _at(c, V, Wd))
    size = _lengths(N)[..., None]
    seen = size > SLIGHT * size.max()  # a ruled face folds flat where it ends in an edge
    N = np.where(seen, N / np.where(seen, size, 1.0), np.nan)
    need = []
    for axis in (2, 3):
        wide, turns = (
            _lengths(np.nan_to_num(np.diff(A, axis=axis))).sum(axis=axis).max(axis=2)
            for A in (X, N)
        )
        need.append(np.maximum(wide / (WIDE * _size(X)), turns / TURN))
    return need[0], need[1]


def _lengths(v: Array) -> Array:
    """Lengths of vectors, (m, n, a, b, 3), as `np.linalg.norm` finds them, but sooner."""
    return np.asarray(np.sqrt(np.einsum("mnabx,mnabx->mnab", v, v)))


def _size(X: Array) -> float:
    """Diagonal of the box that holds the face, mm."""
    return float(np.linalg.norm(np.ptp(X.reshape(-1, 3), axis=0)))


def _refined(breaks: Vector, parts: NDArray[np.int64]) -> Vector:
    steps = [
        a + (b - a) * np.arange(k) / k
        for a, b, k in zip(breaks[:-1], breaks[1:], parts, strict=True)
    ]
    return np.concatenate([*steps, breaks[-1:]])
