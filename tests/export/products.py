"""Blades that the tests of the files share, built once."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np

from bladecad.fit.orbit import Orbit
from bladecad.fit.sidefit import Basis, SideFit
from bladecad.fit.spectrum import Spectrum
from bladecad.pipeline import Build, Settings, build
from bladecad.surface.blade import BladeSurface

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
GOOD = FIXTURES / "broken" / "good.csv"


@cache
def small() -> Build:
    """Four sections of sixty points, within 0.01 mm."""
    return build(GOOD)


@cache
def coarse() -> Build:
    """The same by an order too small for its tolerance."""
    from bladecad.fit.blade import Order

    return build(GOOD, Settings(tolerance=0.001, order=Order(1, 1, 3)))


def spectrum(*knots: float, le: int = 2, te: int = 1, shift: float = 1.0) -> Spectrum:
    """Rates as fits find them: slow and fast ones, decaying and oscillating."""
    pairs = np.array([[12.0 * shift, 20.0], [1457.0, 0.49], [4900.0, -0.8]])
    return Spectrum(5 if knots else 9, pairs[:le], pairs[3 - te :], np.array(knots))


def orbit() -> Orbit:
    """A flow as the paper's fits give it."""
    A = np.random.default_rng(1).normal(size=(4, 4))
    return Orbit(A, np.array([1.0, 2.0, 3.0, 1.0]))


def surface(*bases: Basis, law: str = "spline") -> BladeSurface:
    """Three sections with these bases on both sides and coefficients of all sizes."""
    rng = np.random.default_rng(2)
    C = rng.normal(size=(2, 3, bases[0].size, 3)) * 10.0 ** rng.integers(-3, 4, (1, 1, 1, 3))
    sides = [SideFit(bases, c) for c in C]
    return BladeSurface(np.array([0.0, 1 / 3, 1.0]), *sides, law=law, le="round", te="blunt")
