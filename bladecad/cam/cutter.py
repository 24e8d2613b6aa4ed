"""The largest ball cutter that reaches all of a blade, and the spacing of its passes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Vector, seal
from bladecad.cam.places import Places
from bladecad.deviation.nearest.skin import Skin, search
from bladecad.errors import ToleranceError
from bladecad.surface.blade import BladeSurface
from bladecad.surface.loft import SIDES

LARGEST: Final = 2.0  # of the size of the blade; a ball that large is as good as a plane
HALVINGS: Final = 16
TIGHT: Final = 0.9  # of the curvature that a ball just fits: beyond, passes are no wider apart


@final
@dataclass(frozen=True, eq=False)
class Passes:
    """Iso-lines of the surface as passes of a ball cutter, for one height of the scallops.

    at       : (k,) float, u of lines along the chord, or t of lines along the span
    narrowest, widest : mm from one line to the next on the surface that the scallop allows
    """

    at: Vector
    narrowest: float
    widest: float

    def __post_init__(self) -> None:
        seal(self, at=(None,))


def largest_ball(skin: Skin, found: Places, leave: float) -> tuple[float, int] | None:
    """Radius of the largest ball that reaches every place but for `leave` mm, and the place.

    A ball that touches at a place and goes in elsewhere by g must be lifted by as much: halving,
    with the places where it is too deep. None where any ball will do. Ripples of a fit at the
    edges, a micrometre deep, have no meaning to a cutter; `leave` says so.
    """
    size = float(np.linalg.norm(np.ptp(found.points, axis=0)))
    low, high = 0.0, LARGEST * size
    active = np.flatnonzero(_deep(skin, found, np.arange(found.k1.size), high) > leave)
    if len(active) == 0:
        return None
    for _ in range(HALVINGS):
        middle = np.sqrt(max(low, 1e-3 * high) * high)
        deep = _deep(skin, found, active, middle) > leave
        low, high = (low, middle) if deep.any() else (middle, high)
        active = active[deep] if deep.any() else active
    return float(low), int(active[_deep(skin, found, active, high).argmax()])


def _deep(skin: Skin, found: Places, which: NDArray[np.intp], radius: float) -> Vector:
    """How deep a ball that touches at places goes in elsewhere, mm."""
    centre = found.points[which] + radius * found.directions[which]
    return np.asarray(radius - np.abs(search(skin, centre).distance))


def spacing(k: Array, radius: float, scallop: float) -> Array:
    """Distance along the surface of two passes of a ball that leave a scallop, mm.

    Of a ball of radius R on a cylinder of curvature k across the passes (positive convex), exact:

        s = 4/k asin(k/2 sqrt(h (2R - h) / ((1 + k R) (1 + k h)))),

    which is 2 sqrt(h (2R - h)) on a plane. (Two sides R and the angle s k between the centres, at
    1/k + R from the axis, meet at 1/k + h: the law of cosines.)

    Parameters
    ----------
    k : array, 1/mm
        Where the ball hardly fits, k R < -0.9, the spacing is that of k R = -0.9.
    radius, scallop : float, mm

    Raises
    ------
    ToleranceError
        Unless 0 < scallop < radius.
    """
    if not 0.0 < scallop < radius < np.inf:
        raise ToleranceError(
            f"a scallop of {scallop:g} mm with a ball of radius {radius:g} mm; give more than 0, "
            "and the scallop below the radius"
        )
    k = np.maximum(k, -TIGHT / radius)
    q = np.sqrt(scallop * (2.0 * radius - scallop) / ((1.0 + k * radius) * (1.0 + k * scallop)))
    half = np.clip(0.5 * k * q, -1.0, 1.0)  # beyond, the ball turns round in the hollow
    safe = np.where(np.abs(half) > 1e-8, half, 1.0)
    return np.asarray(2.0 * q * np.where(np.abs(half) > 1e-8, np.arcsin(half) / safe, 1.0))


def passes(
    surface: BladeSurface, found: Places, *, radius: float, scallop: float
) -> tuple[Passes, Passes]:
    """Place passes along the chord, at some u, and passes along the span, at some t of each side.

    Between two lines nowhere is wider than the scallop allows: their density in u is the largest
    |w| / s along each line, w the part of S_u across S_t, s the spacing for the curvature of the
    surface along w; likewise in t. Both sides are cut by the same lines.
    """
    wide = [_density(surface, found, way, radius, scallop) for way in (0, 1)]
    (across_u, s_u), (across_t, s_t) = wide
    in_u = Passes(_places(found.u, across_u.max(axis=(0, 2))), float(s_u.min()), float(s_u.max()))
    in_t = Passes(_places(found.t, across_t.max(axis=(0, 1))), float(s_t.min()), float(s_t.max()))
    return in_u, in_t


def _density(
    surface: BladeSurface, found: Places, way: int, radius: float, scallop: float
) -> tuple[Array, Array]:
    """Lines needed per unit of u (way 0) or t (way 1), and their spacing, (2, m, n) each."""

    def D(du: int, dt: int) -> Array:
        return np.array([surface(s, found.u, found.t, du, dt) for s in SIDES])

    along, across = (D(0, 1), D(1, 0)) if way == 0 else (D(1, 0), D(0, 1))
    c = _dot(across, along) / _dot(along, along)
    w = across - c[..., None] * along
    e, f, g = (-_dot(D(*d), found.n) for d in ((2, 0), (1, 1), (0, 2)))
    first, last = (e, g) if way == 0 else (g, e)
    size = np.linalg.norm(w, axis=-1)
    k = (first - 2.0 * c * f + c**2 * last) / size**2
    s = spacing(k, radius, scallop)
    return size / s, s


def _places(x: Vector, density: Vector) -> Vector:
    mass = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(x))])
    count = max(int(np.ceil(mass[-1])), 1)
    return np.interp(np.linspace(0.0, mass[-1], count + 1), mass, x)


def _dot(a: Array, b: Array) -> Array:
    return np.asarray(np.einsum("suty,suty->sut", a, b))
