"""Patches cut along t, turned round, and joined into one: the same surface on other patches."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from bladecad.arrays import Array, Vector
from bladecad.errors import GeometryError
from bladecad.surface.patch import SplinePatch

CUBIC = 3
ROUNDING = 1e-12  # of the coordinates; poles on both sides of a joint that agree to it are C2


def cut(patch: SplinePatch, first: float, last: float) -> SplinePatch:
    """Return the part first <= t <= last, exact, on knots from 0 to 1 again."""
    p, knots, poles = patch.degree_t, patch.knots_t, np.moveaxis(patch.poles, 1, 0)
    for t in (first, last):
        while np.count_nonzero(knots == t) < p:
            knots, poles = _inserted(knots, poles, p, t)
    i = np.searchsorted(knots, first, side="right") - p - 1
    j = np.searchsorted(knots, last, side="left")
    inner = knots[(knots > first) & (knots < last)]
    ends = [np.full(p + 1, end) for end in (0.0, 1.0)]
    knots = np.concatenate([ends[0], (inner - first) / (last - first), ends[1]])
    return SplinePatch(np.moveaxis(poles[i:j], 0, 1), patch.knots_u, knots, patch.degree_u, p)


def turned_round(patch: SplinePatch) -> SplinePatch:
    """Return the patch with t counted from its other end."""
    knots = 1.0 - patch.knots_t[::-1]
    return SplinePatch(patch.poles[:, ::-1], patch.knots_u, knots, patch.degree_u, patch.degree_t)


def joined(first: SplinePatch, second: SplinePatch) -> SplinePatch:
    """Join two patches that `matched` made meet, end to start, into one; the joint is at t = 1/2.

    Of the pole columns L2, L1, L0 = R0, R1, R2 about a joint that is C2 one is left between L2 and
    R2, and the knot there is simple: no trace of the joint remains. Where it is C1, L1 and R1 stay,
    and the knot is double.

    Raises
    ------
    GeometryError
        If the knots do not mirror each other, or the degree is not 3.
    """
    near = [first.poles[:, ::-1], second.poles]
    seen = _beyond(*_next_knots(first, second), near)
    c2 = np.linalg.norm(seen[1] - seen[0], axis=-1).max() <= ROUNDING * np.abs(second.poles).max()
    middle = [0.5 * (seen[0] + seen[1])] if c2 else [near[0][:, 1], near[1][:, 1]]
    poles = [first.poles[:, :-2], np.stack(middle, axis=1), second.poles[:, 2:]]
    before, after = first.knots_t[: -CUBIC - 1], second.knots_t[CUBIC + 1 :]
    return SplinePatch(
        np.concatenate(poles, axis=1),
        first.knots_u,
        np.concatenate([0.5 * before, [0.5] * len(middle), 0.5 + 0.5 * after]),
        first.degree_u,
        CUBIC,
    )


def matched(
    first: SplinePatch, second: SplinePatch, *, allowed: float
) -> tuple[SplinePatch, SplinePatch, float]:
    """Make two patches meet C2, or where that would take too much C1, so that joining is exact.

    Parameters
    ----------
    first, second : SplinePatch
        Cubic in t, the knots of the first those of the second mirrored, as on both sides of an
        edge.
    allowed : float
        mm, for C2. Patches that meet with one tangent and one curvature, but not with one X_tt,
        as offsets do, then stay as they are and meet C1.

    Returns
    -------
    first, second : SplinePatch
        The pole columns at the joint moved, the others as they were.
    moved : float
        Largest distance by which a pole moved, mm: no point of the patches moved further, for the
        B-splines are positive and sum to 1. Above `allowed` where they have no common tangent.

    Notes
    -----
    With the knots -a2, -a1, 0, a1, a2 and the blossom f of one cubic about the joint the poles are
    L2 = f(-a2,-a1,0), L1 = f(-a1,0,0), L0 = f(0,0,0); f(-a1,0,.) is affine, so C2 is one condition,
    Q = f(-a1,0,a1) seen from both sides (Ramshaw, Blossoms are polar forms, 1989), and C1 is
    L0 = (L1 + R1) / 2.
    """
    a1, a2 = _next_knots(first, second)
    sides = [first.poles[:, ::-1], second.poles]
    seen = _beyond(a1, a2, sides)
    Q = 0.5 * (seen[0] + seen[1])
    for near in ([(a1 * side[:, 2] + a2 * Q) / (a1 + a2) for side in sides],
                 [side[:, 1] for side in sides]):  # fmt: skip
        joint = 0.5 * (near[0] + near[1])
        new = [np.concatenate([np.stack([joint, beside], axis=1), side[:, 2:]], axis=1)
               for beside, side in zip(near, sides, strict=True)]  # fmt: skip
        moved = max(np.linalg.norm(a - b, axis=-1).max() for a, b in zip(new, sides, strict=True))
        if moved <= allowed:
            break
    return _with(first, new[0][:, ::-1]), _with(second, new[1]), float(moved)


def _next_knots(first: SplinePatch, second: SplinePatch) -> tuple[float, float]:
    """The two knots after the joint, counted from it, the same on both sides."""
    mirrored = len(first.knots_t) == len(second.knots_t) and np.allclose(
        1.0 - first.knots_t[::-1], second.knots_t, rtol=0, atol=1e-12
    )
    if not mirrored or first.degree_t != CUBIC or second.degree_t != CUBIC:
        raise GeometryError(
            f"patches of degree {first.degree_t} and {second.degree_t} cannot be joined: they must "
            "be cubic along t, on knots that mirror each other"
        )
    a1, a2 = second.knots_t[CUBIC + 1 : CUBIC + 3]
    return float(a1), float(a2)


def _beyond(a1: float, a2: float, sides: Sequence[Array]) -> list[Array]:
    """f(-a1,0,a1) as each side sees it, from f(-a2,-a1,0) and f(-a1,0,0); poles from the joint."""
    return [P[:, 1] + (a1 / a2) * (P[:, 1] - P[:, 2]) for P in sides]


def _with(patch: SplinePatch, poles: Array) -> SplinePatch:
    return SplinePatch(poles, patch.knots_u, patch.knots_t, patch.degree_u, patch.degree_t)


def _inserted(knots: Vector, poles: Array, p: int, t: float) -> tuple[Vector, Array]:
    """Insert one knot (Boehm, Inserting new knots into B-spline curves, 1980); poles first axis."""
    k = int(np.searchsorted(knots, t, side="right")) - 1
    i = np.arange(k - p + 1, k + 1)
    alpha = ((t - knots[i]) / (knots[i + p] - knots[i]))[:, None, None]
    new = (1.0 - alpha) * poles[i - 1] + alpha * poles[i]
    poles = np.concatenate([poles[: k - p + 1], new, poles[k:]])
    return np.insert(knots, k + 1, t), poles
