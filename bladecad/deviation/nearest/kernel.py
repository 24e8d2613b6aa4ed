"""The hot loop: the nearest place of the squares to each point, compiled."""

# mypy: disable-error-code="untyped-decorator,no-any-return"
from __future__ import annotations

import numpy as np
from numba import njit

from bladecad.arrays import Array, Points, Vector
from bladecad.deviation.nearest.newton import foot
from bladecad.deviation.nearest.squares import P, Q

NEAR = 1e-9  # mm, feet that are as far: on a border, the one its normal points from best is taken
DEPTH = 64  # of the stack
GROUP, MANY = 64, 256  # points at most that share a search, and squares that they may need


@njit(cache=True, nogil=True)
def beyond(low: Points, high: Points, k: int, x: float, y: float, z: float) -> float:
    """Squared distance of a point from box k along x, y, z."""
    a = max(low[k, 0] - x, 0.0, x - high[k, 0])
    b = max(low[k, 1] - y, 0.0, y - high[k, 1])
    c = max(low[k, 2] - z, 0.0, z - high[k, 2])
    return a * a + b * b + c * c


@njit(cache=True, nogil=True)
def beyond_own(
    centre: Points, axes: Array, half: Points, s: int, x: float, y: float, z: float
) -> float:
    """Squared distance of a point from box s along its own axes."""
    d = 0.0
    a, b, c = x - centre[s, 0], y - centre[s, 1], z - centre[s, 2]
    for k in range(3):
        e = abs(axes[s, k, 0] * a + axes[s, k, 1] * b + axes[s, k, 2] * c) - half[s, k]
        if e > 0.0:
            d += e * e
    return d


@njit(cache=True, nogil=True)
def nearest(
    points: Points, order: Array, low: Points, high: Points, item: Array,
    centre: Points, axes: Array, half: Points, start: Array, c: Array, sign: Vector,
    which: Array, place: Points, distance: Vector, feet: Points, normal: Points,
    reach: float,
) -> int:  # fmt: skip
    """Find the foot of each point; points that follow each other in `order` should be near.

    Points within `reach` of the first, x, are a group; for x the tree is searched, the nearer child
    first: distance d. No point of the group, all within r of x, is further than d + r from the
    blade, so its foot lies on a square within d + 2r of x. Those are collected, and each point
    tries them, the nearest box first, as long as they are nearer than the best foot so far.

    All in one body: a call that takes the arrays along costs as much as the step it makes.

    Fills `which`, `place` (v, w), `distance` (signed), `feet`, `normal`; returns how many points
    did not settle.
    """
    if c.shape[1] != P + 1 or c.shape[2] != Q + 1:
        raise ValueError("the compiled loop is of other degrees than the squares: clear its cache")
    X = np.empty((6, 3))
    stack, bounds = np.empty(DEPTH, np.int64), np.empty(DEPTH)
    held, far = np.empty(MANY, np.int64), np.empty(MANY)
    leaves, unsettled, count, end, last = len(item) - 1, 0, 0, 0, -1
    for k in range(len(order)):
        one = order[k]
        x, y, z = points[one, 0], points[one, 1], points[one, 2]
        best, facing, settled = np.inf, -1.0, True
        grouped = k < end
        j, top = 0, 1
        stack[0], bounds[0], begin = 0, 0.0, 0
        if grouped:
            for i in range(count):
                far[i] = beyond_own(centre, axes, half, held[i], x, y, z)
                begin = i if far[i] < far[begin] else begin
        elif last >= 0:  # the foot of the point before is a first bound
            d = (x - feet[last, 0]) ** 2 + (y - feet[last, 1]) ** 2 + (z - feet[last, 2]) ** 2
            best = (np.sqrt(d) + NEAR) ** 2
        while True:
            s = -1  # the next square to try
            if grouped:
                while j < count and s < 0:
                    i = begin if j == 0 else (0 if j == begin else j)
                    s = held[i] if far[i] <= best else -1
                    j += 1
            else:
                while top and s < 0:
                    top -= 1
                    node = stack[top]
                    if bounds[top] > best:
                        continue
                    if node >= leaves:
                        s = item[node - leaves]
                        s = s if beyond_own(centre, axes, half, s, x, y, z) <= best else -1
                        continue
                    a, b = 2 * node + 1, 2 * node + 2
                    da, db = beyond(low, high, a, x, y, z), beyond(low, high, b, x, y, z)
                    if da < db:
                        a, b, da, db = b, a, db, da
                    stack[top], bounds[top] = a, da
                    top += da <= best
                    stack[top], bounds[top] = b, db
                    top += db <= best
            if s < 0:
                break
            p, q, r = x - start[s, 0, 0], y - start[s, 0, 1], z - start[s, 0, 2]
            v = 0.5 + start[s, 1, 0] * p + start[s, 1, 1] * q + start[s, 1, 2] * r
            w = 0.5 + start[s, 2, 0] * p + start[s, 2, 1] * q + start[s, 2, 2] * r
            v, w = min(max(v, 0.0), 1.0), min(max(w, 0.0), 1.0)
            v, w, d, still = foot(c, s, x, y, z, v, w, X)
            d = np.sqrt(d)
            if facing >= 0.0 and d > abs(distance[one]) + NEAR:
                continue
            n0 = sign[s] * (X[1, 1] * X[2, 2] - X[1, 2] * X[2, 1])
            n1 = sign[s] * (X[1, 2] * X[2, 0] - X[1, 0] * X[2, 2])
            n2 = sign[s] * (X[1, 0] * X[2, 1] - X[1, 1] * X[2, 0])
            size = max(np.sqrt(n0 * n0 + n1 * n1 + n2 * n2), 1e-300)  # 0 in a corner
            n0, n1, n2 = n0 / size, n1 / size, n2 / size
            along = n0 * (x - X[0, 0]) + n1 * (y - X[0, 1]) + n2 * (z - X[0, 2])
            if facing >= 0.0 and d >= abs(distance[one]) - NEAR and abs(along) <= facing:
                continue
            which[one], place[one, 0], place[one, 1] = s, v, w
            distance[one] = d if along >= 0.0 else -d
            feet[one, 0], feet[one, 1], feet[one, 2] = X[0, 0], X[0, 1], X[0, 2]
            normal[one, 0], normal[one, 1], normal[one, 2] = n0, n1, n2
            best, facing, settled = min(best, (d + NEAR) ** 2), abs(along), still
        unsettled += not settled
        last = one
        if grouped:
            continue
        end, r = k + 1, 0.0
        while end < len(order) and end - k <= GROUP:
            i = order[end]
            d = (points[i, 0] - x) ** 2 + (points[i, 1] - y) ** 2 + (points[i, 2] - z) ** 2
            if d > reach * reach:
                break
            r, end = max(r, d), end + 1
        if end == k + 1:
            continue
        best = (abs(distance[one]) + 2.0 * np.sqrt(r) + NEAR) ** 2
        count, top, stack[0] = 0, 1, 0
        while top and count < MANY:
            top -= 1
            node = stack[top]
            if node >= leaves:
                s = item[node - leaves]
                if s >= 0 and beyond_own(centre, axes, half, s, x, y, z) <= best:
                    held[count] = s
                    count += 1
                continue
            for i in range(2 * node + 1, 2 * node + 3):
                stack[top] = i
                top += beyond(low, high, i, x, y, z) <= best
        if count == MANY:
            end = k + 1  # far from the blade: one by one
    return unsettled
