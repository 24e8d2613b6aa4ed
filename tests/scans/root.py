"""Made-up roots: fillet, platform and fir tree below a blade, and the cap above it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from bladecad.surface.loft import SIDES, graded

ROUND = 241  # places along each side of a loop
LEVELS = np.linspace(0.0, 1.0, 129)


@dataclass(frozen=True)
class Root:
    """How a root looks; lengths as shares of the chord at the hub.

    end    : "flat" a plane across the stacking axis, above the whole hub line; "revolution" the
             surface of revolution about z through the hub line, or just above it
    fillet : radius between airfoil and platform
    density : points per area, as a share of that on the airfoil
    """

    end: Literal["flat", "revolution"] = "flat"
    fillet: float = 0.05
    margin: float = 0.25
    thickness: float = 0.12
    depth: float = 0.6
    lobes: int = 2
    density: float = 0.5


@dataclass(frozen=True, eq=False)
class Chart:
    """Coordinates a along the chord, b across it, h off the end wall, all mm."""

    frame: np.ndarray  # rows a, b, h (flat), or (2, 2) rows a, b in z and arc (revolution)
    origin: np.ndarray
    wall: np.ndarray | None = None  # radius of the end wall, polynomial of z
    mean: tuple[float, float] = (0.0, 0.0)  # angle and radius in the middle

    def into(self, X):
        if self.wall is None:
            return (X - self.origin) @ self.frame.T
        x, y, z = np.moveaxis(X, -1, 0)
        angle, radius = self.mean
        turned = np.angle(np.exp(1j * (np.arctan2(y, x) - angle)))
        flat = np.stack([z - self.origin[2], radius * turned], -1) @ self.frame.T
        h = np.hypot(x, y) - np.polyval(self.wall, z - self.origin[2])
        return np.concatenate([flat, h[..., None]], -1)

    def out(self, A):
        if self.wall is None:
            return A @ self.frame + self.origin
        angle, radius = self.mean
        z, arc = np.moveaxis(A[..., :2] @ self.frame, -1, 0)
        r = np.polyval(self.wall, z) + A[..., 2]
        angle = angle + arc / radius
        return np.stack([r * np.cos(angle), r * np.sin(angle), z + self.origin[2]], -1)


def chart_of(surface, end) -> Chart:
    """Lay the end wall through the hub line so that no place of it is below."""
    t = np.linspace(0.0, 1.0, 201)
    ends = np.concatenate([surface(s, np.array([0.0, 1.0]), t) for s in SIDES], axis=1)
    chord = np.diff(surface("suction", np.array([0.0]), np.array([0.0, 1.0]))[0], axis=0)[0]
    if end == "flat":
        h = ends[1].mean(axis=0) - ends[0].mean(axis=0)
        h /= np.linalg.norm(h)
        a = chord - (chord @ h) * h
        a /= np.linalg.norm(a)
        origin = ends[0].mean(axis=0)
        return Chart(np.array([a, np.cross(h, a), h]), origin + h * ((ends[0] - origin) @ h).max())
    x, y, z = ends[0].T
    middle, angle = ends[0].mean(axis=0), np.arctan2(y.mean(), x.mean())
    wall = np.polyfit(z - middle[2], np.hypot(x, y), 2)
    wall[-1] += (np.hypot(x, y) - np.polyval(wall, z - middle[2])).max()
    rough = Chart(np.eye(2), middle, wall, (angle, float(np.hypot(x, y).mean())))
    le, te = rough.into(surface("suction", np.array([0.0]), np.array([0.0, 1.0]))[0])
    a = (te - le)[:2] / np.linalg.norm((te - le)[:2])
    return Chart(np.array([a, [-a[1], a[0]]]), rough.origin, wall, rough.mean)


@dataclass(frozen=True, eq=False)
class Stand:
    """A blade on its root: a tube of loops from the airfoil down to the foot of the fir tree.

    loops run along the suction side from the leading to the trailing edge, and back.
    """

    surface: object
    root: Root

    @cached_property
    def chart(self) -> Chart:
        return chart_of(self.surface, self.root.end)

    @cached_property
    def chord(self):
        return float(np.linalg.norm(np.diff(self.surface(
            "suction", np.array([0.0]), np.array([0.0, 1.0]))[0], axis=0)))  # fmt: skip

    @property
    def fillet(self):
        """Radius of the fillet, mm: the airfoil begins that far off the end wall."""
        return self.root.fillet * self.chord

    def height(self, X):
        return self.chart.into(X)[..., 2]

    def begins(self, name, t, h=None):
        """u at which a side is h off the end wall, by default where the fillet ends."""
        heights = self.height(self.surface(name, LEVELS, t))
        h = self.fillet if h is None else h
        return np.array([np.interp(h, column, LEVELS) for column in heights.T])

    def loop(self, h):
        """The airfoil h off the end wall, in the chart, (2 ROUND - 2, 2), and its normals."""
        t = graded(ROUND)
        X = [self.chart.into(self.surface.at(s, self.begins(s, t, h), t))[:, :2] for s in SIDES]
        ring = np.concatenate([X[0], X[1][-2:0:-1]])
        along = np.roll(ring, -1, 0) - np.roll(ring, 1, 0)
        n = np.stack([along[:, 1], -along[:, 0]], 1) / np.linalg.norm(along, axis=1)[:, None]
        area = np.sum(ring[:, 0] * np.roll(ring[:, 1], -1) - ring[:, 1] * np.roll(ring[:, 0], -1))
        return ring, n * np.sign(area)

    @cached_property
    def rings(self):
        """Fillet, platform and fir tree as loops in the chart, (m, n, 3), from above downwards."""
        r, rows = self.fillet, []
        for angle in np.linspace(0.0, np.pi / 2, 13):
            h = r * (1 - np.sin(angle))
            ring, n = self.loop(h)
            rows.append(_at(ring + r * (1 - np.cos(angle)) * n, h))
        foot = rows[-1][:, :2]
        plate, below = self._rectangle(foot), self.root.thickness * self.chord
        rows += [_at((1 - s) * foot + s * plate, 0.0) for s in np.linspace(0.0, 1.0, 9)[1:]]
        rows += [_at(plate, -s * below) for s in np.linspace(0.0, 1.0, 4)[1:]]
        middle = plate.mean(axis=0) * [1.0, 0.0] + [0.0, 0.5 * np.ptp(plate[:, 1])
                                                    + plate[:, 1].min()]  # fmt: skip
        depth = self.root.depth * self.chord
        for s in np.linspace(0.0, 1.0, 49):
            wide = (0.62 - 0.25 * s) * (1 + 0.16 * np.cos(2 * np.pi * self.root.lobes * s))
            rows.append(_at(middle + (plate - middle) * [0.9, wide], -below - s * depth))
        rows += [_at(middle + (rows[-1][:, :2] - middle) * s, -below - depth) for s in (0.5, 0.0)]
        return np.array(rows)

    def _rectangle(self, foot):
        """Places on a rectangle round the foot of the fillet, beside those of the loop."""
        low, high = foot.min(axis=0), foot.max(axis=0)
        wide = self.root.margin * self.chord
        rim = np.array([0.4 * wide, wide])
        low, high = low - rim, high + rim
        k, n = np.arange(len(foot)), ROUND - 1
        up = np.sign(np.mean(foot[:ROUND, 1]) - np.mean(foot[ROUND:, 1]))
        share = (foot[:, 0] - foot[:, 0].min()) / np.ptp(foot[:, 0])
        x = low[0] + share * (high[0] - low[0])
        on_suction = np.where(k <= n, up, -up) > 0
        y = np.where(on_suction, high[1], low[1])
        for end, at in ((share < 0.03, low[0]), (share > 0.97, high[0])):
            reach = np.abs(share - (0.0 if at == low[0] else 1.0)) / 0.03
            side = (low[1] + high[1]) / 2 + np.where(on_suction, 0.5, -0.5) * reach * (high - low)[
                1
            ]
            x, y = np.where(end, at, x), np.where(end, side, y)
        inner = (share >= 0.03) & (share <= 0.97)
        x = np.where(inner, low[0] + (share - 0.03) / 0.94 * (high[0] - low[0]), x)
        return np.stack([x, y], 1)

    @cached_property
    def cap(self):
        """The face over the tip as loops in space, (m, n, 3), from its rim inwards."""
        return cap(self.surface)


def cap(surface):
    t = graded(ROUND)
    S, P = (surface(s, np.array([1.0]), t)[0] for s in SIDES)
    ring = np.concatenate([S, P[-2:0:-1]])
    middle = 0.5 * np.concatenate([S + P, (S + P)[-2:0:-1]])
    return np.array([(1 - s) * ring + s * middle for s in np.linspace(0.0, 1.0, 5)])


def _at(ring, h):
    return np.column_stack([ring, np.full(len(ring), h)])


def strips(rows, columns, start=0):
    """Triangles of a tube of closed loops, (k, 3)."""
    ids = start + np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = ids[:-1], np.roll(ids, -1, 1)[:-1], np.roll(ids, -1, 1)[1:], ids[1:]
    return np.stack([np.stack([a, b, c], -1), np.stack([a, c, d], -1)], 2).reshape(-1, 3)
