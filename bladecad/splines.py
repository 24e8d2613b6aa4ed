"""B-spline bases in numpy alone, so that a saved blade can be evaluated anywhere."""

from __future__ import annotations

import numpy as np

from bladecad.arrays import Array, Vector


def basis(knots: Vector, degree: int, x: Vector, order: int = 0) -> Array:
    """Evaluate all B-splines on the knots, or one of their derivatives, at many places.

    Parameters
    ----------
    knots : (n + degree + 1,) float
        Rising, with the ends repeated degree + 1 times.
    degree : int
    x : (k,) float
        Outside the knots the end polynomials are continued.
    order : int
        Order of the derivative, 0 for the value.

    Returns
    -------
    (k, n) float
        Column i is the i-th B-spline N_i, or its derivative.

    Notes
    -----
    Cox-de Boor recursion; N_i' = p (N_i/(k_{i+p} - k_i) - N_{i+1}/(k_{i+p+1} - k_{i+1}))
    with the B-splines of degree p - 1 on the right (de Boor, A Practical Guide to Splines, ch. X).
    """
    if order > degree:
        return np.zeros((len(x), len(knots) - degree - 1))
    if order == 0:
        return _cox_de_boor(np.asarray(knots), degree, np.asarray(x, dtype=np.float64))
    lower = basis(knots, degree - 1, x, order - 1) * _inverse(knots[degree:] - knots[:-degree])
    return np.asarray(degree * (lower[:, :-1] - lower[:, 1:]))


def clamped(breaks: Vector, degree: int) -> Vector:
    """Return the knot vector with simple inner knots at `breaks[1:-1]` and full ends."""
    return np.concatenate([[breaks[0]] * degree, breaks, [breaks[-1]] * degree])


def not_a_knot(nodes: Vector) -> tuple[Vector, int]:
    """Return the knots and degree of the spline that interpolates at `nodes`.

    Cubic with the second and last but one node left out (C2, order 4) from four nodes on;
    the parabola through three; the straight line through two.
    """
    degree = min(3, len(nodes) - 1)
    inner = nodes[2:-2] if degree == 3 else nodes[:0]
    return clamped(np.concatenate([nodes[:1], inner, nodes[-1:]]), degree), degree


def _cox_de_boor(knots: Vector, degree: int, x: Vector) -> Array:
    first = np.searchsorted(knots, knots[0], side="right") - 1
    last = np.searchsorted(knots, knots[-1], side="left") - 1
    span = np.clip(np.searchsorted(knots, x, side="right") - 1, first, last)
    values = np.zeros((len(x), len(knots) - 1))
    values[np.arange(len(x)), span] = 1.0
    for p in range(1, degree + 1):
        rise = (x[:, None] - knots[None, :-p]) * _inverse(knots[p:] - knots[:-p])
        fall = 1.0 - rise
        values = rise[:, :-1] * values[:, :-1] + fall[:, 1:] * values[:, 1:]
    return values


def _inverse(gaps: Vector) -> Vector:
    return np.divide(1.0, gaps, out=np.zeros_like(gaps), where=gaps > 0)
