"""The airfoil of a scan cut into sections: ordered, smooth loops from hub to tip."""

from __future__ import annotations

from typing import Final

import numpy as np

from bladecad.arrays import Points, Vector
from bladecad.curves.plausible import first_crossing
from bladecad.data.sections import Section, Sections, Source
from bladecad.errors import DataError
from bladecad.one_thread import one_thread
from bladecad.scans.finding.airfoil import Airfoil
from bladecad.scans.finding.evenly import skin
from bladecad.scans.finding.skeleton import Skeleton, legendre, skeleton
from bladecad.scans.finding.slabs import slabs
from bladecad.scans.slicing.capsule import Capsule
from bladecad.scans.slicing.renew import DENSE, renewed
from bladecad.scans.slicing.smooth import smooth

A_SECTION: Final = 6_000  # points that one is found from, where there are so many
SPREAD: Final = 250_000  # places on a mesh
THICKEST: Final = 0.05  # of the span: half of a slab
ROUNDS: Final = 8
FEWEST: Final = 10  # points that a circle is laid through
WITHIN: Final = (0.25, 1.5)  # times the radius of the rough shape
BENT: Final = 8.0  # radii over which the inner line is bent to the centre of the edge
RADII: Final = (0.0015, 0.06)  # of the chord, between which an edge radius must lie
LINE: Final = 480
STIFF: Final = (1.0, 1e2, 1e4)  # least weights of smoothness that are tried
OUTLINE: Final = 320  # points of a loop
THIN: Final = 0.05  # of the largest thickness: thinner, a rough shape may cross itself


def slice_airfoil(airfoil: Airfoil, count: int = 21) -> Sections:
    """Cut the airfoil of a scan into sections.

    Parameters
    ----------
    airfoil : Airfoil
    count : int
        Sections, evenly spaced in height from its lower to its upper end.

    Returns
    -------
    Sections
        Closed loops, hub first, in mm, in the frame of the scan.

    Raises
    ------
    DataError
        If the points round a section are too few.
    """
    with one_thread():
        points = skin(airfoil.scan, max(SPREAD, count * A_SECTION), ~airfoil.lonely, airfoil.taken)
        radius, middle = airfoil.height.middle(points)
        flat = airfoil.height.flat(points, radius, middle)
        flat = flat[np.argsort(flat[:, 2], kind="stable")]
        low, high = airfoil.low, airfoil.high
        found = slabs(flat, np.linspace(low, high, 41))
        if (found.quality > 0.0).sum() < 4:
            raise DataError("too few points round the airfoil to slice it")
        shape = skeleton(flat, found, found.quality > 0.0)
        sections = []
        for k, z in enumerate(np.linspace(low, high, count)):
            loop = section(flat, shape, float(z), low, high)
            lifted = np.column_stack([loop, np.full(len(loop), z)])
            sections.append(Section(f"{k + 1}", airfoil.height.round(lifted, radius, middle)))
        source = airfoil.scan.source
        return Sections(
            tuple(sections), Source(source.path, source.format, source.unit, source.unit_from)
        )


def section(flat: Points, shape: Skeleton, height: float, low: float, high: float) -> Points:
    """The loop at one height, (n, 2), mm; `flat` is sorted by its height."""
    slab, lift = _slab(flat, height, low, high)
    X, Y, _ = shape.place(slab)
    chord = float(shape.place(np.array([[0.0, 0.0, height]]))[2][0])
    q = np.stack([X, Y], axis=1) * chord
    loop = _loop(q, lift, _inner(shape, height, chord, q), outline(shape, height) * chord)
    start, along = (v[0] for v in shape.frame(np.array([height])))
    e = along / np.linalg.norm(along)
    return np.asarray(start + loop @ np.stack([e, [-e[1], e[0]]]))


def _slab(flat: Points, height: float, low: float, high: float) -> tuple[Points, Vector]:
    """Points about a height, inside the airfoil, and their height over it as -1 .. 1."""
    h = flat[:, 2]
    half = float(
        np.clip(
            0.5 * (high - low) * A_SECTION / len(h), 0.002 * (high - low), THICKEST * (high - low)
        )
    )
    middle = float(np.clip(height, low + half, high - half))
    first, last = np.searchsorted(h, (middle - half, middle + half))
    slab = flat[first:last]
    slab = slab[:: max(len(slab) // A_SECTION, 1)]
    return slab, (slab[:, 2] - height) / half


def _inner(shape: Skeleton, height: float, chord: float, q: Points) -> Capsule:
    """The camber line between the centres of the edges."""
    share = shape.share(np.array([height]))
    along_c, along_t = (
        (legendre(share, c.shape[1] - 1) @ c.T)[0] for c in (shape.camber, shape.thickness)
    )
    X = np.linspace(0.0, 1.0, LINE)
    Y = np.polynomial.legendre.legval(2.0 * X - 1.0, along_c)
    line = np.stack([X, Y], axis=1) * chord
    half = np.sqrt(X * (1.0 - X)) * np.polynomial.legendre.legval(2.0 * X - 1.0, along_t)
    begin, r0 = _circle(line[:8], q, chord * _inscribed(X, half))
    end, r1 = _circle(line[:-9:-1], q, chord * _inscribed(X, half[::-1]))
    run = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
    at = np.linspace(r0, run[-1] - r1, LINE)
    inner = np.stack([np.interp(at, run, line[:, i]) for i in (0, 1)], axis=1)
    for end_of, centre, width in ((at - at[0], begin, r0), (at[-1] - at, end, r1)):
        fade = np.exp(-((end_of / (BENT * width)) ** 2))
        inner = inner + fade[:, None] * (centre - inner[int(end_of.argmin())])
    return Capsule(inner, (r0, r1))


def _inscribed(X: Vector, half: Vector) -> float:
    """How far from an edge the half thickness is no more than the way to the edge."""
    return float(np.clip(X[np.argmax((half <= X) & (X > 0.0))], *RADII))


def _circle(line: Points, q: Points, guess: float) -> tuple[Vector, float]:
    """Centre and radius of the edge at the begin of a line, by the points beside it."""
    T = (line[-1] - line[0]) / np.linalg.norm(line[-1] - line[0])
    d = q - line[0]
    s, across = d @ T, d @ np.array([-T[1], T[0]])
    beside = (np.abs(across) < 3.0 * guess) & (s > -2.0 * guess) & (s < 4.0 * guess)
    s, across = s[beside], across[beside]
    a, b, r = guess, 0.0, guess
    for _ in range(ROUNDS):
        near = s < a + 0.2 * r
        if near.sum() < FEWEST:
            return line[0] + guess * T, guess
        A = np.stack([s[near], across[near], np.ones(int(near.sum()))], axis=1)
        c = np.linalg.lstsq(A, s[near] ** 2 + across[near] ** 2)[0]
        new = float(np.sqrt(max(c[2] + 0.25 * (c[0] ** 2 + c[1] ** 2), 0.0)))
        a, b, r = 0.5 * (a + 0.5 * c[0]), 0.5 * (b + 0.5 * c[1]), 0.5 * (r + new)
    if (
        not (WITHIN[0] * guess < r < WITHIN[1] * guess)
        or abs(b) > guess
        or not -guess < a < 3 * guess
    ):
        return line[0] + guess * T, guess
    return line[0] + a * T + b * np.array([-T[1], T[0]]), r


def outline(shape: Skeleton, height: float) -> Points:
    """The rough loop at one height, (2 LINE, 2), as shares of the chord."""
    turn = np.linspace(0.0, 2.0 * np.pi, 2 * LINE, endpoint=False)
    X = 0.5 * (1.0 - np.cos(turn))
    share = shape.share(np.array([height]))
    camber, thick = (
        np.polynomial.legendre.legval(2.0 * X - 1.0, (legendre(share, c.shape[1] - 1) @ c.T)[0])
        for c in (shape.camber, shape.thickness)
    )
    return np.stack(
        [X, camber + 0.5 * np.sin(turn) * np.maximum(thick, THIN * thick.max())], axis=1
    )


def _loop(q: Points, lift: Vector, inner: Capsule, rough: Points) -> Points:
    """The loop through points, stiffer if it would cross itself; at worst the rough shape."""
    for stiff in STIFF:
        loop = _laid_round(q, lift, inner, rough, stiff)[:: DENSE // OUTLINE]
        if first_crossing(loop, True) is None and _size(loop) < 1.2 * _size(rough):
            return loop
    return rough[:: len(rough) // OUTLINE]


def _size(loop: Points) -> float:
    return float(np.linalg.norm(np.ptp(loop, axis=0)))


def _laid_round(q: Points, lift: Vector, inner: Capsule, rough: Points, stiff: float) -> Points:
    """First as distances from the inner line, then as distances from the loop itself."""
    along, away = inner.place(q)
    at, usual = inner.place(rough)
    order = np.argsort(at)
    at, usual = at[order], usual[order]
    x, run = inner.warp()
    period = float(x[-1])
    expected = np.interp(along, at, usual, period=period)
    number = np.interp(along, x, run) / run[-1]
    f = smooth(number, lift, away - expected, _knots(run[-1]), stiff)
    w = np.linspace(0.0, 1.0, DENSE, endpoint=False)
    places = np.interp(w * run[-1], run, x)
    loop = inner.back(places, f(w) + np.interp(places, at, usual, period=period))
    noise = f.noise
    for _ in range(2):
        loop, noise = renewed(loop, inner.tips, q, lift, noise, stiff)
    return loop


def _knots(run: float) -> int:
    return int(np.clip(run, 60, 200))
