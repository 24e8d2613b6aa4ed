"""Blades in closed form for what a cutter must know."""

from __future__ import annotations

from functools import cache

import numpy as np

from bladecad.fit.orbit import Orbit
from bladecad.fit.sidefit import SideFit
from bladecad.pipeline.blade_file import load_blade
from bladecad.pipeline.build import Settings
from bladecad.surface.blade import BladeSurface
from tests.export.products import GOOD


@cache
def good() -> BladeSurface:
    """A tapered, twisted blade of four sections, with round edges."""
    return load_blade(GOOD, Settings(tolerance=0.01)).surface


def tube(
    a: float = 10.0,
    b: float = 10.0,
    height: float = 40.0,
    *,
    taper: float = 0.0,
    bow: float = 0.0,
    beside: float = 0.0,
    sections: int = 2,
) -> BladeSurface:
    """An elliptic tube along z, from x = -a to x = a, exact: half the turn that is a flow a side.

    taper : share by which the tip is smaller
    beside : mm in x of the axis of the tube from the origin
    bow   : mm by which half span stands off towards +y, a parabola in u
    """  # fmt: skip
    A = np.zeros((3, 3))
    A[:2, :2] = np.pi * np.array([[0.0, -1.0], [1.0, 0.0]])
    orbit, span = Orbit(A, np.array([1.0, 0.0, 1.0])), np.linspace(0.0, 1.0, sections)
    scale, off = 1.0 - taper * span, 4.0 * bow * span * (1.0 - span)
    sides = [
        np.array([[[-a * s, 0, 0], [0, y * b * s, 0], [beside, o, height * u]]
                  for u, s, o in zip(span, scale, off, strict=True)])
        for y in (1.0, -1.0)
    ]  # fmt: skip
    return BladeSurface(span, *(SideFit((orbit,), C) for C in sides))


def waisted(
    a: float = 10.0, b: float = 3.0, waist: float = 0.8, height: float = 40.0
) -> BladeSurface:
    """A prism, y = b (sin - waist sin^3) over x = -a cos: thin half-way, and concave there.

    At t = 1/2 it is 2 b (1 - waist) thick, with a concave radius of a^2 / (b (3 waist - 1)).
    """
    A, spin = np.zeros((5, 5)), np.pi * np.array([[0.0, -1.0], [1.0, 0.0]])
    A[:2, :2], A[2:4, 2:4] = spin, 3.0 * spin
    orbit = Orbit(A, np.array([1.0, 0.0, 1.0, 0.0, 1.0]))
    sides = []
    for y in (1.0, -1.0):
        C = np.zeros((2, 5, 3))
        C[:, 0, 0] = -a
        C[:, 1, 1], C[:, 3, 1] = y * b * (1.0 - 0.75 * waist), y * b * 0.25 * waist
        C[1, 4, 2] = height
        sides.append(SideFit((orbit,), C))
    return BladeSurface(np.array([0.0, 1.0]), *sides)
