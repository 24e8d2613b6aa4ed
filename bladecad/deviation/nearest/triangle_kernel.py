"""The hot loop for triangles, compiled."""

# mypy: disable-error-code="untyped-decorator"
from __future__ import annotations

import numpy as np
from numba import njit

from bladecad.arrays import Array, Points, Vector
from bladecad.deviation.nearest.kernel import DEPTH, NEAR, beyond


@njit(cache=True, nogil=True)
def closest(a: Vector, b: Vector, c: Vector, x: Vector) -> tuple[float, float]:
    """Barycentric v and w of the place of a + v (b - a) + w (c - a) that is nearest to x.

    Ericson, Real-Time Collision Detection (2005), section 5.1.5.
    """
    d1 = d2 = d3 = d4 = d5 = d6 = 0.0
    for k in range(3):
        ab, ac = b[k] - a[k], c[k] - a[k]
        d1 += ab * (x[k] - a[k])
        d2 += ac * (x[k] - a[k])
        d3 += ab * (x[k] - b[k])
        d4 += ac * (x[k] - b[k])
        d5 += ab * (x[k] - c[k])
        d6 += ac * (x[k] - c[k])
    if d1 <= 0.0 and d2 <= 0.0:
        return 0.0, 0.0
    if d3 >= 0.0 and d4 <= d3:
        return 1.0, 0.0
    vc = d1 * d4 - d3 * d2
    if vc <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        return d1 / (d1 - d3), 0.0
    if d6 >= 0.0 and d5 <= d6:
        return 0.0, 1.0
    vb = d5 * d2 - d1 * d6
    if vb <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        return 0.0, d2 / (d2 - d6)
    va = d3 * d6 - d5 * d4
    if va <= 0.0 and d4 >= d3 and d5 >= d6:
        w = (d4 - d3) / ((d4 - d3) + (d5 - d6))
        return 1.0 - w, w
    total = va + vb + vc
    return vb / total, vc / total


@njit(cache=True, nogil=True)
def nearest(
    points: Points, order: Array, low: Points, high: Points, item: Array, corners: Array,
    normals: Points, which: Array, place: Points, distance: Vector, feet: Points, normal: Points,
) -> None:  # fmt: skip
    """Search the tree for the foot of each point, the nearer child first.

    Of triangles that are equally far, the one whose normal points best to the point tells the sign:
    on an edge or a corner it is then right (Baerentzen and Aanaes, TVCG 11 (2005), discuss others).
    """
    stack = np.empty(DEPTH, np.int64)
    bounds = np.empty(DEPTH)
    leaves = len(item) - 1
    last = -1
    for k in order:
        x = points[k]
        best, facing = np.inf, 0.0
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
                da, db = (
                    beyond(low, high, a, x[0], x[1], x[2]),
                    beyond(low, high, b, x[0], x[1], x[2]),
                )
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
            p, q, r = corners[s, 0], corners[s, 1], corners[s, 2]
            v, w = closest(p, q, r, x)
            d = along = 0.0
            for i in range(3):
                away = x[i] - (p[i] + v * (q[i] - p[i]) + w * (r[i] - p[i]))
                d += away * away
                along += normals[s, i] * away
            far = np.sqrt(d)
            better = facing == 0.0 or far < abs(distance[k]) - NEAR
            level = abs(far - abs(distance[k])) <= NEAR
            if not (better or (level and abs(along) > facing)):
                continue
            best = min(best, (far + NEAR) ** 2)
            facing = max(abs(along), 1e-300)
            which[k], place[k, 0], place[k, 1] = s, v, w
            distance[k] = far if along >= 0.0 else -far
            for i in range(3):
                feet[k, i] = p[i] + v * (q[i] - p[i]) + w * (r[i] - p[i])
                normal[k, i] = normals[s, i]
        last = k
