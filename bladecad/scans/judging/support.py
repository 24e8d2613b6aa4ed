"""Where no point supports the surface: holes and shadows of a scan, told from thin cover."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final, final

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import label, maximum_filter

from bladecad.arrays import Array, Mask, Points, Vector, seal
from bladecad.deviation.nearest.feet import Feet
from bladecad.scans.judging.cover import Cover, area_of, cover_of, nearest, tree_of
from bladecad.surface.blade import BladeSurface, SideName

SIDES: Final[tuple[SideName, SideName]] = ("suction", "pressure")
MOST: Final = 150_000  # points looked at; of more, as many are drawn
STEP: Final = 0.85  # between places, in spacings; a spacing is that of a square grid, area^1/2
QUARTER: Final = 0.3  # spacings to the nearest of points strewn at random, at a quarter of places
WIDE: Final = 1.5  # of the widest of these circles nearby: no wider disc is empty by chance
LEAST, LARGEST = 2.0, 20.0  # spacings: radius of the smallest disc that is a gap; thinnest cover
ROUND: Final = 2.5  # times the radius of a disc: so far round it the cover is looked at


@final
@dataclass(frozen=True, eq=False)
class Gap:
    """A place of the surface that no point supports.

    side   : "suction" or "pressure"
    u, t   : (lowest, highest) of its places
    area   : mm^2
    centre : (3,) float, mm, a place of it near its middle
    share  : of the area of the side
    """

    side: SideName
    u: tuple[float, float]
    t: tuple[float, float]
    area: float
    centre: Vector
    share: float

    def __post_init__(self) -> None:
        seal(self, centre=(3,))


@final
@dataclass(frozen=True, eq=False)
class Support:
    """Where points support a surface, and where they do not.

    A gap is made of empty discs, wider than random cover leaves between points as thin as those
    round the disc. Cover is thin, not missing, up to `LARGEST` times the usual spacing.

    spacing : mm, the usual distance of neighbours, as of a square grid
    """

    surface: BladeSurface
    covers: tuple[Cover, Cover]
    spacing: float

    @cached_property
    def discs(self) -> tuple[tuple[Points, Vector], ...]:
        """Middles of the empty discs of each side, and their radii, mm."""
        return tuple(_discs(cover, self.spacing) for cover in self.covers)

    def __call__(self, side: SideName, u: Vector, t: Vector) -> NDArray[np.bool_]:
        """Whether points support the places of the grid u x t, (len(u), len(t))."""
        return ~_in_discs(self.surface(side, u, t), *self.discs[SIDES.index(side)])

    @cached_property
    def gaps(self) -> tuple[Gap, ...]:
        """All gaps, largest first."""
        found = [g for c, d in zip(self.covers, self.discs, strict=True) for g in _gaps(c, *d)]
        return tuple(sorted(found, key=lambda gap: -gap.area))


def support_of(surface: BladeSurface, feet: Feet) -> Support:
    """Find out where points support a surface.

    Parameters
    ----------
    surface : BladeSurface
    feet : Feet
        Of the points that count, on this surface; those beyond the span are left out.

    Notes
    -----
    The cover is judged side by side: points across a thin edge support nothing. The distance to
    the nearest point is measured at places all over the surface; where it is large, the spacing
    of the points round the place says whether that is chance. Ten million points cost no more.
    """
    counts = np.flatnonzero(~feet.rim)
    if len(counts) > MOST:
        counts = np.sort(np.random.default_rng(0).choice(counts, MOST, replace=False))
    area = area_of(surface, "suction") + area_of(surface, "pressure")
    step = STEP * float(np.sqrt(area / max(len(counts), 1)))
    on = feet.suction[counts]
    suction = cover_of(surface, "suction", feet, counts[on], step)
    pressure = cover_of(surface, "pressure", feet, counts[~on], step)
    near = np.concatenate([suction.near.ravel(), pressure.near.ravel()])
    quarter = float(np.quantile(near, 0.25, method="lower"))
    usual = quarter / QUARTER if np.isfinite(quarter) else step / STEP
    return Support(surface, (suction, pressure), usual)


def find_gaps(surface: BladeSurface, feet: Feet) -> tuple[Gap, ...]:
    """Find the places of a surface that no point supports, largest first."""
    return support_of(surface, feet).gaps


def supported(
    surface: BladeSurface, feet: Feet, side: SideName, u: Vector, t: Vector
) -> NDArray[np.bool_]:
    """Whether points support the places of the grid u x t of one side, (len(u), len(t))."""
    return support_of(surface, feet)(side, u, t)


def _discs(cover: Cover, spacing: float) -> tuple[Points, Vector]:
    """Middles and radii of the discs that are empty for more than thin cover, (k, 3) and (k,)."""
    radius = np.full(cover.near.shape, LARGEST * spacing)
    wide, step = spacing, STEP * spacing
    while wide < LARGEST * spacing:
        size = 2 * int(np.ceil(ROUND * 2.0 * wide / step)) + 1
        found = WIDE * maximum_filter(cover.reach, size, mode="constant")
        level = (cover.near > wide) & (cover.near <= 2.0 * wide) & (found > 0.0)
        wanted = found[level] * _cut_off(cover, step)[level]
        radius[level] = np.clip(wanted, LEAST * spacing, LARGEST * spacing)
        wide *= 2.0
    empty = cover.near > radius
    return cover.X[empty], radius[empty]


def _cut_off(cover: Cover, step: float) -> Array:
    """How much wider a disc must be where hub, tip or an edge halves it, (a, b)."""
    i, j = (np.arange(k) for k in cover.near.shape)
    shorter = (np.minimum(x, x[::-1]) * step for x in (i, j))
    halved = [x < 0.5 * cover.near for x in np.meshgrid(*shorter, indexing="ij")]
    return np.asarray(np.sqrt(2.0) ** (halved[0].astype(float) + halved[1]))


def _in_discs(X: Array, middles: Points, radius: Vector) -> NDArray[np.bool_]:
    """Which places lie in an empty disc, of the shape of X without its last axis."""
    if not len(middles):
        return np.zeros(X.shape[:-1], bool)
    away, which = nearest(tree_of(middles), X.reshape(-1, 3), 1, float(radius.max()) * (1 + 1e-9))
    found = np.isfinite(away)
    found[found] = away[found] <= radius[which[found]]
    return np.asarray(found.reshape(X.shape[:-1]))


def _gaps(cover: Cover, middles: Points, radius: Vector) -> list[Gap]:
    number, count = label(_in_discs(cover.X, middles, radius), np.ones((3, 3)))
    return [_gap(cover, number == k) for k in range(1, count + 1)]


def _gap(cover: Cover, inside: Mask) -> Gap:
    i, j = np.nonzero(inside)
    area, X = cover.area[inside], cover.X[inside]
    middle = np.average(X, axis=0, weights=area)
    return Gap(
        cover.side,
        (float(cover.u[i.min()]), float(cover.u[i.max()])),
        (float(cover.t[j.min()]), float(cover.t[j.max()])),
        float(area.sum()),
        X[np.argmin(np.linalg.norm(X - middle, axis=1))],
        float(area.sum() / cover.area.sum()),
    )
