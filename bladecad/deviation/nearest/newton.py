"""Newton's method for the foot of a point on one square, compiled.

Rows of arrays are named by their number, never taken out: a view is counted by its owner, and two
threads that count the same owner wait for each other.
"""

# mypy: disable-error-code="untyped-decorator,no-any-return"
from __future__ import annotations

from numba import njit

from bladecad.arrays import Array
from bladecad.deviation.nearest.squares import P, Q

STEPS = 40
STILL = 1e-10  # mm, a step that is as short is not taken
SHORT = 1e-6  # mm, one that is as short is the last: what it leaves is of its second order


@njit(cache=True, nogil=True, fastmath={"contract", "nsz"})
def evaluate(c: Array, s: int, v: float, w: float, X: Array) -> None:
    """X, X_v, X_w, X_vv, X_vw, X_ww of square s into the rows of X by Horner's rule."""
    for x in range(3):
        f0 = f1 = f2 = g0 = g1 = h0 = 0.0  # f: of X along v, g: of X_w, h: of X_ww
        for i in range(P, -1, -1):
            a = b = d = 0.0
            for j in range(Q, -1, -1):
                d = d * w + b
                b = b * w + a
                a = a * w + c[s, i, j, x]
            f2 = f2 * v + f1
            f1 = f1 * v + f0
            f0 = f0 * v + a
            g1 = g1 * v + g0
            g0 = g0 * v + b
            h0 = h0 * v + 2.0 * d
        X[0, x], X[1, x], X[2, x] = f0, f1, g0
        X[3, x], X[4, x], X[5, x] = 2.0 * f2, g1, h0


@njit(cache=True, nogil=True)
def foot(
    c: Array, s: int, x: float, y: float, z: float, v: float, w: float, X: Array
) -> tuple[float, float, float, bool]:
    """Newton on |X(v,w) - x|^2 / 2 in the unit square, with its true second derivatives.

    Gauss-Newton where they are not positive definite; a coordinate held at its bound by the
    gradient does not move; a step that leads away is halved. Returns v, w, the squared distance,
    and whether it settled; X holds the square and its derivatives there.
    """
    evaluate(c, s, v, w, X)
    best = (X[0, 0] - x) ** 2 + (X[0, 1] - y) ** 2 + (X[0, 2] - z) ** 2
    for _ in range(STEPS):
        dv, dw, E, F, G = _step(X, x, y, z, v, w)
        halved = False
        while True:
            new_v, new_w = min(max(v + dv, 0.0), 1.0), min(max(w + dw, 0.0), 1.0)
            sv, sw = new_v - v, new_w - w
            length = sv * sv * E + 2.0 * sv * sw * F + sw * sw * G
            if length <= STILL * STILL:
                if halved:
                    evaluate(c, s, v, w, X)
                return v, w, best, True
            evaluate(c, s, new_v, new_w, X)
            d = (X[0, 0] - x) ** 2 + (X[0, 1] - y) ** 2 + (X[0, 2] - z) ** 2
            if d <= best:
                break
            dv, dw, halved = 0.5 * dv, 0.5 * dw, True
        v, w, best = new_v, new_w, d
        if length <= SHORT * SHORT and not halved:
            return v, w, best, True
    return v, w, best, False


@njit(cache=True, nogil=True)
def _step(
    X: Array, x: float, y: float, z: float, v: float, w: float
) -> tuple[float, float, float, float, float]:
    """Newton's step, and the first fundamental form E, F, G."""
    E = X[1, 0] * X[1, 0] + X[1, 1] * X[1, 1] + X[1, 2] * X[1, 2]
    F = X[1, 0] * X[2, 0] + X[1, 1] * X[2, 1] + X[1, 2] * X[2, 2]
    G = X[2, 0] * X[2, 0] + X[2, 1] * X[2, 1] + X[2, 2] * X[2, 2]
    p, q, r = X[0, 0] - x, X[0, 1] - y, X[0, 2] - z
    gv = p * X[1, 0] + q * X[1, 1] + r * X[1, 2]
    gw = p * X[2, 0] + q * X[2, 1] + r * X[2, 2]
    a = E + p * X[3, 0] + q * X[3, 1] + r * X[3, 2]
    b = F + p * X[4, 0] + q * X[4, 1] + r * X[4, 2]
    c = G + p * X[5, 0] + q * X[5, 1] + r * X[5, 2]
    if not (a > 0.0 and c > 0.0 and a * c - b * b > 1e-6 * E * G):
        a, b, c = E, F, G
    held_v = (v <= 0.0 and gv > 0.0) or (v >= 1.0 and gv < 0.0)
    held_w = (w <= 0.0 and gw > 0.0) or (w >= 1.0 and gw < 0.0)
    if held_v or held_w or a * c - b * b <= 1e-14 * a * c:  # held, or the square is a line here
        dv = 0.0 if held_v or a <= 0.0 else -gv / a
        dw = 0.0 if held_w or c <= 0.0 else -gw / c
    else:
        det = a * c - b * b
        dv, dw = (b * gw - c * gv) / det, (b * gv - a * gw) / det
    return dv, dw, E, F, G
