"""Made-up scans of a synthetic blade, with known deviations."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from bladecad.curves.sides import split_sides
from bladecad.data.scan import Scan
from bladecad.data.sections import Source
from bladecad.data.synthetic import synthetic_blade
from bladecad.deviation.nearest.feet import Feet
from bladecad.fit.blade import Order
from bladecad.pipeline import Settings, fit, surface_of
from bladecad.surface.blade import BladeSurface, outward

AXIS = 2


@dataclass(frozen=True)
class Still:
    """Stands for a registration that moves nothing."""

    T_nominal_scan = np.eye(4)


@cache
def blade(trailing_edge: str = "round") -> BladeSurface:
    sections = synthetic_blade(5, 80, trailing_edge=trailing_edge)
    settings = Settings(order=Order(2, 2, 9), tolerance=0.05)
    return surface_of(fit(split_sides(sections), settings))


def normals_at(surface, name, u, t):
    n = np.cross(surface.at(name, u, t, 1, 0), surface.at(name, u, t, 0, 1))
    return n / np.linalg.norm(n, axis=1, keepdims=True) * outward(surface, name)


def feet_at(surface, suction, u, t, d, face=None, rim=None) -> Feet:
    """Feet on the sides, as projection would find them."""
    k = len(u)
    foot, normal = np.empty((k, 3)), np.empty((k, 3))
    for name, on in (("suction", suction), ("pressure", ~suction)):
        foot[on] = surface.at(name, u[on], t[on])
        normal[on] = normals_at(surface, name, u[on], t[on])
    face = np.where(suction, 0, 1) if face is None else face
    rim = np.zeros(k, bool) if rim is None else rim
    d = np.broadcast_to(d, k)
    return Feet(d, foot, normal, face.astype(np.int8), suction, u, t, rim)


def placed(suction, u, t, d=0.0) -> Feet:
    """Feet of which only side, u, t and deviation are told."""
    k, nowhere = len(u), np.zeros((len(u), 3))
    face = np.where(suction, 0, 1).astype(np.int8)
    d = np.broadcast_to(d, k)
    return Feet(d, nowhere, nowhere, face, suction, u, t, np.zeros(k, bool))


def strewn(count, seed=0, low=0.0, high=1.0):
    """Side, u and t of points strewn over a blade."""
    rng = np.random.default_rng(seed)
    return rng.random(count) < 0.5, rng.uniform(low, high, count), rng.random(count)


def scan_of(surface, suction, u, t, d=0.0) -> Scan:
    """Points that stand d off a blade along its normal."""
    feet = feet_at(surface, suction, u, t, d)
    return Scan(feet.foot + feet.distance[:, None] * feet.normal, None, Source(None, "made up"))


def moved(surface, move) -> BladeSurface:
    """The blade whose coefficients of section i are move(i, C_i, one): one is the constant 1."""

    def side(fit):
        ones = [fit.bases[i if len(fit.bases) > 1 else 0].one for i in range(len(fit.coefficients))]
        new = [
            move(i, C, one) for i, (C, one) in enumerate(zip(fit.coefficients, ones, strict=True))
        ]
        return replace(fit, coefficients=np.array(new))

    return replace(surface, suction=side(surface.suction), pressure=side(surface.pressure))
