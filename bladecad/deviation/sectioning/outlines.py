"""Chord, thickness, radii and so on of many outlines of one section at once.

An outline is the loop of a station, laid flat, moved. The nominal, the actual and the slightly
changed outlines that tell the uncertainty go through the same formulas, so an unchanged blade has
no deviation at all.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final, final

import numpy as np

from bladecad.arrays import Array, Vector
from bladecad.deviation.sectioning.loops import (
    Indices,
    at,
    centroids,
    circle,
    crossing,
    dot,
    middle_of_top,
    peak,
    slope,
    top,
)
from bladecad.deviation.sectioning.station import SAMPLES, Station

END: Final = 0.05  # of the side: the ends of the chord lie nearer to the edges
TURNS: Final = 5  # of chord direction and ends, each far better than the one before
NOSE: Final = np.radians(60.0)  # either way of where the edge points
INNER: Final = 0.06  # of the side from the edges: circles that touch both sides
EVERY: Final = 4  # samples between two circles
WINDOW: Final = 12  # samples either way in which a circle touches the other side


@final
@dataclass(frozen=True, eq=False)
class Formulas:
    """The numbers of a section as functions of its outline.

    station    : the nominal section
    le_offsets, te_offsets : mm, where edge thickness is measured
    """

    station: Station
    le_offsets: tuple[float, ...]
    te_offsets: tuple[float, ...]

    def __call__(self, X: Array) -> dict[str, Array]:
        """All numbers of outlines (m, n, 2), each (m,); mm, degrees and, for the centroid, mm."""
        le, te, e = self.chord_line(X)
        along, across = e[:, 0], e[:, 1]
        found = {
            "chord": self.chord_scale * np.linalg.norm(te - le, axis=1),
            "stagger": np.degrees(np.arctan2(-across, along)),
        }
        found |= self._circles(X, le, e)
        found |= self.radii(X) | self._edges(X, le, te, e)
        return found | self._centroid(X)

    def chord_line(self, X: Array) -> tuple[Array, Array, Array]:
        """Ends of the chord, and its direction: the longest line from edge to edge; (m, 2) each."""
        chord = X[:, SAMPLES - 1] - X[:, 0]
        e = chord / np.linalg.norm(chord, axis=1)[:, None]
        for _ in range(TURNS):
            le, te = self._end(X, -e, self.le_ring), self._end(X, e, self.te_ring)
            e = te - le
            e = e / np.linalg.norm(e, axis=1)[:, None]
        return le, te, e

    def _end(self, X: Array, e: Array, ring: Indices) -> Array:
        """The furthest place of an edge in direction e; the middle of a cut-off one."""
        if len(ring) <= 2:
            return np.asarray(X[:, ring].mean(axis=1))
        return at(X[:, ring], *top(dot(X[:, ring], e[:, None])))

    def _circles(self, X: Array, le: Array, e: Array) -> dict[str, Array]:
        """The largest circle between the sides, and the furthest centre of any from the chord."""
        r, centre = self.inscribed(X)
        away = centre - le[:, None]
        x, y = dot(away, e[:, None]), dot(away, self.up(e)[:, None])
        k, w = top(r)
        thick = 2.0 * at(r[:, :, None], k, w)[:, 0] * self.scale_at(self.touching[k])
        bend = float(np.sign(y[0, np.abs(y[0]).argmax()]))
        return {
            "maximum thickness": thick,
            "maximum thickness place": self.chord_scale * middle_of_top(r, x),
            "camber": self.chord_scale * bend * at((bend * y)[:, :, None], *top(bend * y))[:, 0],
        }

    def inscribed(self, X: Array) -> tuple[Array, Array]:
        """Radii and centres of the circles that touch the suction side and the other, (m, i).

        The circle that touches at p with inward normal n and passes through q has the radius
        |q - p|^2 / (2 n . (q - p)); the inscribed one is the smallest over q.
        """
        i = self.touching
        p = X[:, i]
        T = slope(X, i)
        n = -self.hand * np.stack([T[..., 1], -T[..., 0]], axis=2)
        q = X[:, self.partners]
        away = q - p[:, :, None]
        into = np.maximum(dot(away, n[:, :, None]), 1e-9)
        r = -peak(-dot(away, away) / (2.0 * into))
        return r, p + r[..., None] * n

    def radii(self, X: Array) -> dict[str, Array]:
        """Radii of the round edges of outlines (m, n, 2), each (m,), mm."""
        found = {}
        for name, kind, ring in (
            ("leading", self.station.le, self.le_ring),
            ("trailing", self.station.te, self.te_ring),
        ):
            if kind == "round":
                facing = np.maximum(self._facing(X, ring) - np.cos(NOSE), 0.0)
                radius = circle(X[:, ring[1:-1]], facing * self.station.lengths[ring[1:-1]])
                found[f"{name} edge radius"] = radius * self.scale_at(ring[len(ring) // 2])
        return found

    def _facing(self, X: Array, ring: Indices) -> Array:
        """Cosine between the normals of an edge and where it points, halfway between its sides."""
        T = slope(X[:, ring], np.arange(1, len(ring) - 1))
        n = self.hand * np.stack([T[..., 1], -T[..., 0]], axis=2)
        e = n[:, 0] - n[:, -1]
        e = self.hand * np.stack([-e[:, 1], e[:, 0]], axis=1)
        e = e / np.linalg.norm(e, axis=1)[:, None]
        return dot(n, e[:, None])

    def _edges(self, X: Array, le: Array, te: Array, e: Array) -> dict[str, Array]:
        found = {}
        ends = (
            ("leading", le, e, self.le_offsets),
            ("trailing", te, -e, self.te_offsets),
        )
        for name, end, inwards, offsets in ends:
            for offset in offsets:
                key = f"{name} edge thickness at {offset:g} mm"
                found[key] = self._across(X, end, inwards, offset, name == "trailing")
        return found

    def _across(self, X: Array, end: Array, e: Array, offset: float, from_te: bool) -> Array:
        """Thickness across the line from the end of the chord to the middle between the sides."""
        scale = self.scale_at(SAMPLES - 1 if from_te else 0)
        order = slice(None, None, -1 if from_te else 1)
        S, P = (X[:, self.station.side(s)[order]] - end[:, None] for s in ("suction", "pressure"))
        for _ in range(TURNS):
            up = self.up(e)
            a, b = (crossing(dot(Y, e[:, None]), Y, offset / scale) for Y in (S, P))
            middle = 0.5 * (a + b)
            e = middle / np.linalg.norm(middle, axis=1)[:, None]
        return np.asarray(scale * np.abs(dot(a - b, up)))

    def _centroid(self, X: Array) -> dict[str, Array]:
        """Shift of the centroid of the area from that of the nominal."""
        shift = centroids(X) - centroids(self.station.flat[None])
        scale = float(self.station.scale.mean())
        along, up = self.nominal_e, self.up(self.nominal_e[None])[0]
        return {"bow along": scale * shift @ along, "bow across": scale * shift @ up}

    def up(self, e: Array) -> Array:
        """Directions across some chords, towards the suction side."""
        return np.asarray(self.hand * np.stack([e[:, 1], -e[:, 0]], axis=1))

    def scale_at(self, k: Indices | int) -> Array:
        """True over flat length at some points."""
        return np.asarray(self.station.scale[k])

    @cached_property
    def hand(self) -> float:
        """1 where the loop runs counter-clockwise in the flat, else -1."""
        x, y = self.station.flat.T
        return float(np.sign(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))))

    @cached_property
    def nominal_e(self) -> Vector:
        """Direction of the nominal chord in the flat."""
        return np.asarray(self.chord_line(self.station.flat[None])[2][0])

    @cached_property
    def chord_scale(self) -> float:
        """True over flat length along the chord."""
        flat, true = (
            np.linalg.norm(X[SAMPLES - 1] - X[0]) for X in (self.station.flat, self.station.points)
        )
        return float(true / flat)

    @cached_property
    def le_ring(self) -> Indices:
        """Points about the leading edge, in order; the corners of a cut-off one."""
        n = len(self.station.t)
        if self.station.le != "round":
            return np.array([n - 1, 0]) if self.station.le == "blunt" else np.array([0])
        near = int(np.searchsorted(self.station.t[:SAMPLES], END))
        return np.arange(-near, near + 1) % n

    @cached_property
    def te_ring(self) -> Indices:
        """Points about the trailing edge, in order; the corners of a cut-off one."""
        if self.station.te != "round":
            last = SAMPLES - 1
            return np.array([last, last + 1]) if self.station.te == "blunt" else np.array([last])
        near = SAMPLES - 1 - int(np.searchsorted(self.station.t[:SAMPLES], 1.0 - END))
        return np.arange(SAMPLES - 1 - near, SAMPLES + near)

    @cached_property
    def le_nose(self) -> Indices | None:
        """Points of the arc whose radius is measured."""
        return self._nose(self.le_ring) if self.station.le == "round" else None

    @cached_property
    def te_nose(self) -> Indices | None:
        """Points of the arc whose radius is measured."""
        return self._nose(self.te_ring) if self.station.te == "round" else None

    def _nose(self, ring: Indices) -> Indices:
        """Points of an edge that face within 60 degrees of where it points, between its sides."""
        facing = self._facing(self.station.flat[None], ring)[0] > np.cos(NOSE)
        return np.asarray(ring[1:-1][facing])

    @cached_property
    def touching(self) -> Indices:
        """Points of the suction side where circles touch it."""
        t = self.station.t[:SAMPLES]
        return np.flatnonzero((t > INNER) & (t < 1.0 - INNER))[::EVERY]

    @cached_property
    def partners(self) -> Indices:
        """Points of the pressure side that such a circle may touch, (i, 2 WINDOW + 1)."""
        X, side = self.station.flat, self.station.side("pressure")
        p, n = X[self.touching], -self.station.flat_normal[self.touching]
        away = X[side] - p[:, None]
        into = dot(away, n[:, None])
        r = np.where(into > 1e-9, dot(away, away) / (2.0 * np.maximum(into, 1e-9)), np.inf)
        centre = np.clip(r.argmin(axis=1), WINDOW, len(side) - 1 - WINDOW)
        return np.asarray(side[centre[:, None] + np.arange(-WINDOW, WINDOW + 1)])
