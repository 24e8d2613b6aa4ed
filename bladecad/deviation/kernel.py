"""The hot loop: the nearest place of the squares to each point, compiled."""

# mypy: disable-error-code="untyped-decorator,no-any-return"
from __future__ import annotations

import numpy as np
from numba import njit

from bladecad.arrays import Array, Points, Vector
from bladecad.deviation.squares import P, Q

STEPS = 40
STILL = 1e-10  # mm, a step that is as short is the last
NEAR = 1e-9  # mm, feet that are as far: on a border, the one its normal points from best is taken
DEPTH = 64


@njit(cache=True, nogil=True, fastmath={"contract", "nsz"})
def evaluate(c: Array, v: float, w: float, X: Array) -> None:
    """X, X_v, X_w, X_vv, X_vw, X_ww into the rows of X by Horner's rule."""
    for x in range(3):
        f0 = f1 = f2 = g0 = g1 = h0 = 0.0  # f: of X along v, g: of X_w, h: of X_ww
        for i in range(P, -1, -1):
            a = b = d = 0.0
            for j in range(Q, -1, -1):
                d = d * w + b
                b = b * w + a
                a = a * w + c[i, j, x]
            f2 = f2 * v + f1
            f1 = f1 * v + f0
            f0 = f0 * v + a
            g1 = g1 * v + g0
            g0 = g0 * v + b
            h0 = h0 * v + 2.0 * d
        X[0, x], X[1, x], X[2, x] = f0, f1, g0
        X[3, x], X[4, x], X[5, x] = 2.0 * f2, g1, h0


@njit(cache=True, nogil=True)
def foot(c: Array, x: Vector, v: float, w: float, X: Array) -> tuple[float, float, float, bool]:
    """Newton on |X(v,w) - x|^2 / 2 in the unit square, with its true second derivatives.

    Gauss-Newton where they are not positive definite; a coordinate held at its bound by the
    gradient does not move; a step that leads away is halved. Returns v, w, the squared distance,
    and whether it settled; X holds the square and its derivatives there.
    """
    evaluate(c, v, w, X)
    best = _squared(X, x)
    for _ in range(STEPS):
        dv, dw, E, F, G = _step(X, x, v, w)
        while True:
            new_v, new_w = min(max(v + dv, 0.0), 1.0), min(max(w + dw, 0.0), 1.0)
            sv, sw = new_v - v, new_w - w
            if sv * sv * E + 2.0 * sv * sw * F + sw * sw * G <= STILL * STILL:
                evaluate(c, v, w, X)
                return v, w, best, True
            evaluate(c, new_v, new_w, X)
            d = _squared(X, x)
            if d <= best:
                break
            dv, dw = 0.5 * dv, 0.5 * dw
        v, w, best = new_v, new_w, d
    return v, w, best, False


@njit(cache=True, nogil=True)
def _squared(X: Array, x: Vector) -> float:
    a, b, c = X[0, 0] - x[0], X[0, 1] - x[1], X[0, 2] - x[2]
    return a * a + b * b + c * c


@njit(cache=True, nogil=True)
def _dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@njit(cache=True, nogil=True)
def _step(X: Array, x: Vector, v: float, w: float) -> tuple[float, float, float, float, float]:
    """Newton's step, and the first fundamental form E, F, G."""
    r0, r1, r2 = X[0, 0] - x[0], X[0, 1] - x[1], X[0, 2] - x[2]
    gv = r0 * X[1, 0] + r1 * X[1, 1] + r2 * X[1, 2]
    gw = r0 * X[2, 0] + r1 * X[2, 1] + r2 * X[2, 2]
    E, F, G = _dot(X[1], X[1]), _dot(X[1], X[2]), _dot(X[2], X[2])
    a = E + r0 * X[3, 0] + r1 * X[3, 1] + r2 * X[3, 2]
    b = F + r0 * X[4, 0] + r1 * X[4, 1] + r2 * X[4, 2]
    c = G + r0 * X[5, 0] + r1 * X[5, 1] + r2 * X[5, 2]
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


@njit(cache=True, nogil=True)
def beyond(low: Vector, high: Vector, x: Vector) -> float:
    """Squared distance of a point from a box along x, y, z."""
    d = 0.0
    for k in range(3):
        a = max(low[k] - x[k], 0.0, x[k] - high[k])
        d += a * a
    return d


@njit(cache=True, nogil=True)
def beyond_own(centre: Vector, axes: Array, half: Vector, x: Vector) -> float:
    """Squared distance of a point from a box along its own axes."""
    d = 0.0
    a, b, c = x[0] - centre[0], x[1] - centre[1], x[2] - centre[2]
    for k in range(3):
        e = abs(axes[k, 0] * a + axes[k, 1] * b + axes[k, 2] * c) - half[k]
        if e > 0.0:
            d += e * e
    return d


@njit(cache=True, nogil=True)
def nearest(
    points: Points, order: Array, low: Points, high: Points, item: Array,
    centre: Points, axes: Array, half: Points, start: Array, c: Array, sign: Vector,
    which: Array, place: Points, distance: Vector, feet: Points, normal: Points,
) -> int:  # fmt: skip
    """Search the tree for the foot of each point, the nearer child first.

    A square is tried where its box is nearer than the best foot so far; the foot of the point
    before is a first bound. Fills `which`, `place` (v, w), `distance` (signed), `feet`, `normal`;
    returns how many points did not settle.
    """
    if c.shape[1] != P + 1 or c.shape[2] != Q + 1:
        raise ValueError("the compiled loop is of other degrees than the squares: clear its cache")
    X = np.empty((6, 3))
    n = np.empty(3)
    stack = np.empty(DEPTH, np.int64)
    bounds = np.empty(DEPTH)
    leaves = len(item) - 1
    unsettled = 0
    last = -1
    for k in order:
        x = points[k]
        best, facing, settled = np.inf, 0.0, True
        if last >= 0:
            e = feet[last]
            best = (x[0] - e[0]) ** 2 + (x[1] - e[1]) ** 2 + (x[2] - e[2]) ** 2
            best = (np.sqrt(best) + NEAR) ** 2
        stack[0], bounds[0], top = 0, 0.0, 1
        while top:
            top -= 1
            if bounds[top] > best:
                continue
            node = stack[top]
            if node < leaves:
                a, b = 2 * node + 1, 2 * node + 2
                da, db = beyond(low[a], high[a], x), beyond(low[b], high[b], x)
                if da < db:
                    a, b, da, db = b, a, db, da
                if da <= best:
                    stack[top], bounds[top] = a, da
                    top += 1
                if db <= best:
                    stack[top], bounds[top] = b, db
                    top += 1
                continue
            s = item[node - leaves]
            if beyond_own(centre[s], axes[s], half[s], x) > best:
                continue
            g = start[s]
            a0, a1, a2 = x[0] - g[0, 0], x[1] - g[0, 1], x[2] - g[0, 2]
            v = min(max(0.5 + g[1, 0] * a0 + g[1, 1] * a1 + g[1, 2] * a2, 0.0), 1.0)
            w = min(max(0.5 + g[2, 0] * a0 + g[2, 1] * a1 + g[2, 2] * a2, 0.0), 1.0)
            v, w, d, still = foot(c[s], x, v, w, X)
            far = np.sqrt(d)
            n[0] = sign[s] * (X[1, 1] * X[2, 2] - X[1, 2] * X[2, 1])
            n[1] = sign[s] * (X[1, 2] * X[2, 0] - X[1, 0] * X[2, 2])
            n[2] = sign[s] * (X[1, 0] * X[2, 1] - X[1, 1] * X[2, 0])
            size = max(np.sqrt(_dot(n, n)), 1e-300)  # a corner that is a point has no normal
            along = 0.0
            for i in range(3):
                n[i] /= size
                along += n[i] * (x[i] - X[0, i])
            better = facing == 0.0 or far < abs(distance[k]) - NEAR
            level = abs(far - abs(distance[k])) <= NEAR
            if not (better or (level and abs(along) > facing)):
                continue
            best = min(best, (far + NEAR) ** 2)
            facing, settled = max(abs(along), 1e-300), still
            which[k], place[k, 0], place[k, 1] = s, v, w
            distance[k] = far if along >= 0.0 else -far
            for i in range(3):
                feet[k, i], normal[k, i] = X[0, i], n[i]
        unsettled += not settled
        last = k
    return unsettled
