"""The rough shape of an airfoil: chord, camber and thickness as smooth functions of the height."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from bladecad.arrays import Array, Mask, Points, Vector, seal
from bladecad.scans.finding.slabs import Slabs

ALONG: Final = 6  # degree of camber and thickness over the chord
UP: Final = 4  # degree of both over the height
EDGES: Final = 6  # degree of the ends of the chord over the height
BEYOND: Final = 1.06  # share of the height up to which polynomials are trusted
ROUNDS: Final = 4
MAD: Final = 1.4826
CLEAR: Final = 3.0  # times the usual misfit: points beyond count little
RIDGE: Final = 1e-9
TIP_POINTS: Final = 1_500  # points of a height among which the ends of the chord are found
ENOUGH: Final = 60_000  # points that the shape is found from


@final
@dataclass(frozen=True, eq=False)
class Skeleton:
    """Where the chord of an airfoil lies at each height, and the loop about it.

    low, high : mm, heights between which it was found
    edges     : (7, 4) float; Legendre coefficients over the height, of x and y of both chord ends
    camber    : (7, 5) float; Y over the chord and the height, as a share of the chord
    thickness : (7, 5) float; half of it, over sqrt(X (1 - X))
    misfit    : mm, usual distance of the points from the loop
    """

    low: float
    high: float
    edges: Array
    camber: Array
    thickness: Array
    misfit: float

    def __post_init__(self) -> None:
        shape = (ALONG + 1, UP + 1)
        seal(self, edges=(EDGES + 1, 4), camber=shape, thickness=shape)

    def share(self, height: Vector) -> Vector:
        """Heights as -1 .. 1 between low and high, hardly beyond."""
        share = 2.0 * (np.asarray(height) - self.low) / (self.high - self.low) - 1.0
        return np.asarray(np.clip(share, -BEYOND, BEYOND))

    def frame(self, height: Vector) -> tuple[Array, Array]:
        """Begin of the chord, and the chord as a vector, (k, 2) each, mm."""
        ends = legendre(self.share(height), EDGES) @ self.edges
        return ends[:, :2], ends[:, 2:] - ends[:, :2]

    def place(self, flat: Points) -> tuple[Vector, Vector, Vector]:
        """X along the chord and Y across it, as shares of the chord; the chord; (k,) each."""
        start, chord = self.frame(flat[:, 2])
        d = flat[:, :2] - start
        square = np.einsum("kx,kx->k", chord, chord)
        X = np.einsum("kx,kx->k", d, chord) / square
        Y = (chord[:, 0] * d[:, 1] - chord[:, 1] * d[:, 0]) / square
        return X, Y, np.sqrt(square)

    def off(self, flat: Points) -> tuple[Vector, Vector, Vector, Vector]:
        """X; distance from the camber line; half thickness there; chord; (k,), lengths in mm."""
        X, Y, chord = self.place(flat)
        inside, share = np.clip(X, 0.0, 1.0), self.share(flat[:, 2])
        across = Y - _both(inside, share, self.camber)
        nose = np.sqrt(inside * (1.0 - inside))
        return X, across * chord, nose * _both(inside, share, self.thickness) * chord, chord


def skeleton(flat: Points, found: Slabs, taken: Mask) -> Skeleton:
    """Find the rough shape from points and the slabs that are airfoil.

    Parameters
    ----------
    flat : (k, 3) float, mm
    found : Slabs
    taken : (m,) bool
        Slabs that are airfoil; what lies between the first and the last of them is, too.
    """
    which = np.flatnonzero(taken)
    low, high = float(found.borders[which[0]]), float(found.borders[which[-1] + 1])
    which = which[found.quality[which] > 0.0]
    share = 2.0 * (found.heights[which] - low) / (high - low) - 1.0
    ends = _one_way(found.edges[which]).reshape(-1, 4)
    degree = min(EDGES, len(which) // 3)
    edges = np.zeros((EDGES + 1, 4))
    edges[: degree + 1] = robust(legendre(share, degree), ends)
    empty = np.zeros((ALONG + 1, UP + 1))
    start = Skeleton(low, high, edges, empty, empty, 0.0)
    inside = flat[(flat[:, 2] > low) & (flat[:, 2] < high)]
    inside = inside[:: max(len(inside) // ENOUGH, 1)]
    return _shaped(_to_tips(_shaped(start, inside), inside), inside)


def _to_tips(shape: Skeleton, flat: Points) -> Skeleton:
    """Move the ends of the chord to where the points end."""
    X, across, half, chord = shape.off(flat)
    share = shape.share(flat[:, 2])
    on = np.abs(across) < half + np.maximum(0.02 * chord, 5.0 * shape.misfit)
    bins = int(np.clip(on.sum() // TIP_POINTS, 2 * (EDGES + 1), 40))
    number = np.clip(((share + 1.0) / 2.0 * bins).astype(np.int64), 0, bins - 1)
    found = [X[on & (number == k)] for k in range(bins)]
    there = np.array([len(x) > 20 for x in found])
    at = legendre((np.arange(bins) + 0.5) / bins * 2.0 - 1.0, EDGES)[there]
    reach = [[np.partition(x, 2)[2], np.partition(x, -3)[-3]] for x in found if len(x) > 20]
    c = robust(at, np.array(reach))
    many = np.linspace(-1.0, 1.0, 60)
    A = legendre(many, EDGES)
    start, along = shape.frame(0.5 * (many + 1.0) * (shape.high - shape.low) + shape.low)
    up = np.stack([-along[:, 1], along[:, 0]], axis=1)
    ends = []
    for X in (A @ c).T:
        inside = np.clip(X, 0.005, 0.995)
        Y = _both(inside, many, shape.camber)
        ends.append(start + X[:, None] * along + Y[:, None] * up)
    edges = np.linalg.lstsq(A, np.hstack(ends))[0]
    return replace(shape, edges=edges)


def _shaped(start: Skeleton, flat: Points) -> Skeleton:
    """Find camber and thickness by turns: which side a point is on, then both."""
    X, Y, chord = start.place(flat)
    X = np.clip(X, 0.0, 1.0)
    C, nose = tensor(X, start.share(flat[:, 2])), np.sqrt(X * (1.0 - X))
    coarse = C[: 4 * (UP + 1)]
    across = Y - _least(coarse, Y) @ coarse
    n, weight, A = len(C), np.ones(len(Y)), np.empty((2 * len(C), len(Y)))
    for k in range(ROUNDS):
        root, side = np.sqrt(weight), np.sign(across) * nose
        np.multiply(C, root, out=A[:n])
        np.multiply(A[:n], side, out=A[n:])
        c = _least(A, root * Y)
        across = Y - c[:n] @ C
        off = np.abs(across - side * (c[n:] @ C)) * chord
        usual = max(MAD * float(np.median(off)), 1e-12)
        if k:
            weight = 1.0 / (1.0 + (off / (CLEAR * usual)) ** 2)
    shape = (ALONG + 1, UP + 1)
    return Skeleton(
        start.low, start.high, start.edges, c[:n].reshape(shape), c[n:].reshape(shape), usual
    )


def legendre(x: Vector, degree: int) -> Array:
    """Legendre polynomials at x, (k, degree + 1)."""
    return np.asarray(np.polynomial.legendre.legvander(np.asarray(x), degree))


def tensor(X: Vector, share: Vector) -> Array:
    """Products of polynomials over the chord and over the height, (7 * 5, k)."""
    A, B = legendre(2.0 * X - 1.0, ALONG).T, legendre(share, UP).T
    return np.multiply(A[:, None], B[None], order="C").reshape(-1, len(X))


def robust(A: Array, y: Array, rounds: int = 8) -> Array:
    """Least squares that single outliers do not bend, (n, ...)."""
    weight = np.ones(len(A))
    for _ in range(rounds):
        root = np.sqrt(weight).reshape(-1, 1)
        fit = np.linalg.lstsq(A * root, (y.T * root[:, 0]).T)[0]
        off = np.abs(y - A @ fit)
        off = np.linalg.norm(off, axis=1) if off.ndim == 2 else off
        weight = 1.0 / (1.0 + (off / max(CLEAR * float(np.median(off)), 1e-12)) ** 2) ** 2
    return np.asarray(fit)


def _both(X: Vector, share: Vector, c: Array) -> Vector:
    return np.asarray(
        np.einsum("kj,kj->k", legendre(2.0 * X - 1.0, ALONG) @ c, legendre(share, UP))
    )


def _one_way(edges: Array) -> Array:
    """Swap the ends of the chords that run against their neighbours."""
    chords = edges[:, 1] - edges[:, 0]
    ways = np.sign(np.einsum("mx,mx->m", chords[1:], chords[:-1]))
    way = np.concatenate([[1.0], np.cumprod(np.where(ways == 0.0, 1.0, ways))])
    return np.where(way[:, None, None] < 0.0, edges[:, ::-1], edges)


def _least(A: Array, y: Vector) -> Vector:
    """Least squares of y = c A, a column of A for each point."""
    G = A @ A.T
    G[np.diag_indices_from(G)] += RIDGE * np.trace(G) / len(G)
    return np.asarray(np.linalg.solve(G, A @ y))
