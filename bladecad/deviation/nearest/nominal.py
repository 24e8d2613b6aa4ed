"""What is measured against: the skin of a blade, and the blade coordinates on it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal, Protocol, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Points, Vector
from bladecad.deviation.nearest.feet import FACES
from bladecad.deviation.nearest.skin import Skin, search, skin_of
from bladecad.deviation.nearest.squares import Chart, Squares, cut, joined
from bladecad.deviation.nearest.triangles import TriangleSkin, triangle_skin
from bladecad.surface.blade import BladeSurface, SideName, outward

Kind = Literal["surface", "patches", "mesh"]
ALIGNED = 0.5  # cosine; a triangle that turns further from the airfoil closes it, or is a rim
BEGIN = np.linspace(0.0, 1.0, 9)
CLOSE = 1e-9  # of t: breaks that are one
SIDES: tuple[SideName, SideName] = ("suction", "pressure")


class Patch(Protocol):
    """A four-sided face, as `SplinePatch` is one."""

    @property
    def knots_u(self) -> Vector:
        """Knots in u, from 0 to 1."""

    @property
    def knots_t(self) -> Vector:
        """Knots in t, from 0 to 1."""

    def __call__(self, u: Vector, t: Vector) -> Array:
        """X on the grid u x t, (len(u), len(t), 3), mm."""


@final
@dataclass(frozen=True, eq=False)
class Nominal:
    """The blade as it should be.

    surface : BladeSurface, names side, u and t of every place; of a nominal that is a STEP or mesh
              file it is fitted to sections through it, of all others it is the skin itself
    other   : the skin of such a file, None where it is the surface
    """

    surface: BladeSurface
    other: Skin | TriangleSkin | None = None

    @property
    def kind(self) -> Kind:
        """What the distance is measured to."""
        if self.other is None:
            return "surface"
        return "patches" if isinstance(self.other, Skin) else "mesh"

    @cached_property
    def sides(self) -> Skin:
        """Sides and faces of cut-off edges of the surface."""
        return skin_of(joined(_sides(self.surface)))

    @cached_property
    def closed(self) -> Skin:
        """The same, closed at hub and tip by ruled faces."""
        return skin_of(joined([*_sides(self.surface), *_caps(self.surface)]))

    @property
    def length(self) -> float:
        """Length of the blade along the span, at half chord, mm."""
        u, t = np.linspace(0.0, 1.0, 33), np.array([0.5])
        line = self.surface("suction", u, t)[:, 0]
        return float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())


def nominal_of(surface: BladeSurface) -> Nominal:
    """Take a blade surface as the nominal."""
    return Nominal(surface)


def nominal_of_patches(patches: Sequence[tuple[str, Patch]], surface: BladeSurface) -> Nominal:
    """Take the faces of a file as the nominal.

    Parameters
    ----------
    patches : sequence of (name, patch)
        Of the airfoil, without hub and tip.
    surface : BladeSurface
        Fitted to sections through the faces; it names side, u and t, and which way is out.
    """
    blade = nominal_of(surface)
    parts = [
        cut(patch, np.unique(patch.knots_u), np.unique(patch.knots_t), face=k, sign=1.0)
        for k, (_, patch) in enumerate(patches)
    ]
    return Nominal(surface, skin_of(joined([_turned_outwards(blade, part) for part in parts])))


def nominal_of_mesh(
    vertices: Points, triangles: NDArray[np.int64], surface: BladeSurface
) -> Nominal:
    """Take triangles as the nominal; those that close it at hub and tip are left out.

    Parameters
    ----------
    vertices : (n, 3) float, mm
    triangles : (m, 3) int, counter-clockwise from outside
    surface : BladeSurface
        Fitted to sections through the mesh; it names side, u and t.
    """
    a, b, c = np.moveaxis(np.asarray(vertices, dtype=np.float64)[triangles], 1, 0)
    n = np.cross(b - a, c - a)
    out = search(nominal_of(surface).sides, (a + b + c) / 3.0).normal
    aligned = np.einsum("kx,kx->k", n, out) > ALIGNED * np.linalg.norm(n, axis=1)
    return Nominal(surface, triangle_skin(vertices, triangles[aligned]))


def _turned_outwards(blade: Nominal, part: Squares) -> Squares:
    """Give the squares of one face the sign that agrees with the blade, by most of them."""
    skin = skin_of(part)
    middle = np.ascontiguousarray(skin.start[:, 0])
    out, own = search(blade.sides, middle).normal, search(skin, middle).normal
    sign = 1.0 if np.sum(np.einsum("kx,kx->k", out, own) > 0.0) * 2 >= len(middle) else -1.0
    return replace(part, sign=np.full(len(middle), sign))


def _sides(surface: BladeSurface) -> list[Squares]:
    u = np.unique(surface.knots[0])
    parts = [
        cut(_on(surface, name), u, _breaks(surface, name), face=k, sign=outward(surface, name))
        for k, name in enumerate(SIDES)
    ]
    for end, name, kind in ((0.0, "LEADING_EDGE", surface.le), (1.0, "TRAILING_EDGE", surface.te)):
        if kind == "blunt":
            out = _mean(surface, 0, 1, 0.5, end) * (2.0 * end - 1.0)
            parts.append(_ruled(_across_edge(surface, end), u, BEGIN, name, out))
    return parts


def _breaks(surface: BladeSurface, name: SideName) -> Vector:
    """Where to begin to cut a side along t: also where its flows are restarted."""
    own = [getattr(b, "knots", BEGIN) for b in surface.side(name).bases]
    breaks = np.unique(np.concatenate([BEGIN, *own]))
    return np.asarray(breaks[np.diff(breaks, prepend=-1.0) > CLOSE])


def _caps(surface: BladeSurface) -> list[Squares]:
    return [
        _ruled(
            _across_cap(surface, end),
            np.linspace(0.0, 1.0, 3),
            BEGIN,
            name,
            _mean(surface, 1, 0, end, 0.5) * (2.0 * end - 1.0),
        )
        for end, name in ((0.0, "HUB"), (1.0, "TIP"))
    ]


def _on(surface: BladeSurface, name: SideName) -> Chart:
    return lambda u, t: surface(name, u, t)


def _across_edge(surface: BladeSurface, end: float) -> Chart:
    """X(u,v) = (1 - v) S(u,end) + v P(u,end)."""

    def chart(u: Vector, v: Vector) -> Array:
        S, P = (surface(s, u, np.array([end])) for s in SIDES)
        return np.asarray((1.0 - v[:, None]) * S + v[:, None] * P)

    return chart


def _across_cap(surface: BladeSurface, end: float) -> Chart:
    """X(v,t) = (1 - v) S(end,t) + v P(end,t)."""

    def chart(v: Vector, t: Vector) -> Array:
        S, P = (surface(s, np.array([end]), t) for s in SIDES)
        return np.asarray((1.0 - v[:, None, None]) * S + v[:, None, None] * P)

    return chart


def _mean(surface: BladeSurface, du: int, dt: int, u: float, t: float) -> Vector:
    at = np.array([u]), np.array([t])
    return np.asarray(sum(surface(s, *at, du, dt)[0, 0] for s in SIDES))


def _ruled(
    chart: Callable[[Vector, Vector], Array], u: Vector, t: Vector, name: str, out: Vector
) -> Squares:
    """Cut a ruled face whose outer side is the one that `out` points to."""
    a = np.array([0.5, 0.5 + 1e-4])
    X = chart(a, a)
    n = np.cross(X[1, 0] - X[0, 0], X[0, 1] - X[0, 0])
    return cut(chart, u, t, face=FACES.index(name), sign=1.0 if n @ out > 0 else -1.0)
