"""Do two patches bound a blade? Asked of the arrays, before the kernel is."""

from __future__ import annotations

import numpy as np

from bladecad.arrays import Array, Vector
from bladecad.brep.limits import Limits
from bladecad.errors import GeometryError
from bladecad.surface.patch import SplinePatch

LEAST_AREA = 1e-6  # mm^2; a section smaller than a square micron is no section


def check_sides(suction: SplinePatch, pressure: SplinePatch, limits: Limits) -> None:
    """Refuse patches that do not fit together, coincide, cross, or change sides along the span.

    Raises
    ------
    GeometryError
        With the u and t of the worst place and the distance there.
    """
    _check_shared(suction, pressure)
    for column, edge in ((0, "leading"), (-1, "trailing")):
        _check_edge(suction, pressure, column, edge, limits)
    u, t = _places(suction.knots_u), _places(suction.knots_t)
    across = pressure(u, t) - suction(u, t)
    along = (suction(u, t, 0, 1) + pressure(u, t, 0, 1)) / 2
    normal = np.cross(along, across)
    _check_area(normal, u, t)
    loops = np.concatenate([suction(u, t), pressure(u, t)[:, ::-1]], axis=1)
    _check_crossing(normal, across, _steps(along, t), loops, u, t, limits)


def is_round(suction: SplinePatch, pressure: SplinePatch, column: int) -> bool:
    """Tell whether both sides have that pole column (0 or -1) in common, bit by bit."""
    return np.array_equal(suction.poles[:, column], pressure.poles[:, column])


def _check_shared(suction: SplinePatch, pressure: SplinePatch) -> None:
    same = suction.poles.shape == pressure.poles.shape and all(
        np.array_equal(getattr(suction, name), getattr(pressure, name))
        for name in ("knots_u", "knots_t", "degree_u", "degree_t")
    )
    if not same:
        raise GeometryError(
            f"suction side {suction.poles.shape} and pressure side {pressure.poles.shape} "
            "do not share knots and degrees; project both onto the same knots"
        )


def _check_edge(
    suction: SplinePatch, pressure: SplinePatch, column: int, edge: str, limits: Limits
) -> None:
    if is_round(suction, pressure, column):
        return
    u = _places(suction.knots_u)
    t = suction.knots_t[[column]]
    gap = np.linalg.norm(suction(u, t) - pressure(u, t), axis=-1).ravel()
    if gap.min() < limits.blunt:
        raise GeometryError(
            f"{edge} edge: the sides are {gap.min():.3g} mm apart at u = {u[gap.argmin()]:.3f}; "
            f"share the pole column bit by bit, or keep {limits.blunt:g} mm for a blunt edge"
        )


def _check_area(normal: Array, u: Vector, t: Vector) -> None:
    area = np.trapezoid(np.linalg.norm(normal, axis=-1), t, axis=1)
    if area.min() < LEAST_AREA:
        raise GeometryError(
            f"section at u = {u[area.argmin()]:.3f} has an area of {area.min():.3g} mm^2; "
            "suction and pressure side coincide, or the section has shrunk to a point"
        )


def _check_crossing(
    normal: Array,
    across: Array,
    steps: Array,
    loops: Array,
    u: Vector,
    t: Vector,
    limits: Limits,
) -> None:
    """Follow the section normal, (dS/dt + dP/dt)/2 x (P - S): it turns over where sides cross.

    It turns over on a slanted, cut-off edge too, where one side runs along the cut and the other
    is still on its way; so a section that it accuses must also meet itself.
    """
    side = _turns(normal, axis=1)
    main = np.sign(np.sum(side * np.linalg.norm(normal, axis=-1), axis=1))
    depth = _depth(side * main[:, None] < 0, np.linalg.norm(across, axis=-1), steps)
    for i in np.flatnonzero(depth.max(axis=1) > limits.fold):
        if not _meets_itself(loops[i]):
            depth[i] = 0.0
    if depth.max() > limits.fold:
        i, j = np.unravel_index(depth.argmax(), depth.shape)
        raise GeometryError(
            f"section at u = {u[i]:.3f}: suction and pressure side cross, {depth[i, j]:.3g} mm "
            f"deep at t = {t[j]:.3f}; raise the order of the fit or mend the section"
        )
    mean = np.sum(normal * (side * main[:, None])[..., None], axis=1)
    turned = _turns(mean[None], axis=1)[0]
    if np.any(turned < 0):
        raise GeometryError(
            f"suction and pressure side change places near u = {u[np.argmin(turned)]:.3f}; "
            "look for a swapped or flipped section"
        )


def _meets_itself(loop: Array) -> bool:
    """Whether a loop, seen across its own plane, crosses or touches itself."""
    from shapely import LinearRing

    middle = loop.mean(axis=0)
    plane = np.linalg.svd(loop - middle, full_matrices=False)[2][:2]
    return not LinearRing((loop - middle) @ plane.T).is_simple


def check_fold(cap: SplinePatch, end: str, limits: Limits) -> None:
    """Refuse a ruled cap whose ruling meets one of its own border lines along the tangent.

    cap : u from suction, 0, to pressure, 1; t along the end section
    """
    t = _places(cap.knots_t)
    s = np.array([0.0, 0.5, 1.0])
    across = cap(s, t, 1, 0)
    normal = np.cross(cap(s, t, 0, 1), across)
    gap = np.linalg.norm(across[1], axis=-1)
    folded = np.einsum("sjx,jx->sj", normal, normal[1]).min(axis=0) < 0
    depth = _depth(folded[None], gap[None], _steps(cap(s[1:2], t, 0, 1), t))[0]
    if depth.max() > limits.fold:
        j = int(np.argmax(depth))
        raise GeometryError(
            f"{end} cap folds over itself at t = {t[j]:.3f}, where the section is "
            f"{gap[j]:.3g} mm thick; give both sides the same parameters along the chord"
        )


def _steps(along: Array, t: Vector) -> Array:
    """How far the middle between the sides moves from one place to the next, (nu, nt), mm."""
    return np.asarray(np.linalg.norm(along, axis=-1) * np.gradient(t))


def _depth(turned: Array, gap: Array, steps: Array) -> Array:
    """How deep the sides lie in each other, at most: the gap there, and the way run backwards.

    On a flat, blunted nose the middle hardly moves; a turn there is a matter of nanometres.
    """
    run = np.sum(np.where(turned, steps, 0.0), axis=1, keepdims=True)
    return np.asarray(np.where(turned, np.minimum(gap, run), 0.0))


def _turns(normal: Array, axis: int) -> Array:
    """Return +1 and -1: which way each normal looks, followed from the first along the axis."""
    after = np.take(normal, range(1, normal.shape[axis]), axis=axis)
    before = np.take(normal, range(normal.shape[axis] - 1), axis=axis)
    flips = np.where(np.sum(after * before, axis=-1) < 0, -1.0, 1.0)
    start = np.ones_like(np.take(flips, [0], axis=axis))
    return np.asarray(np.cumprod(np.concatenate([start, flips], axis=axis), axis=axis))


def _places(knots: Vector) -> Vector:
    """Return the ends of the knots and four places inside each span, strictly rising."""
    breaks = np.unique(knots)
    inner = breaks[:-1, None] + np.diff(breaks)[:, None] * np.array([0.12, 0.37, 0.63, 0.88])
    return np.concatenate([breaks[:1], inner.ravel(), breaks[-1:]])
