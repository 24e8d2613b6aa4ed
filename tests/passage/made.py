"""A row in closed form: a straight elliptic prism between two cylinders."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from bladecad.data.sections import Machine, Row
from bladecad.fit.orbit import Orbit
from bladecad.fit.sidefit import SideFit
from bladecad.pipeline.blade_file import BladeFile
from bladecad.surface.blade import BladeSurface, EdgeKind

HUB, SHROUD, LOW, HIGH = 100.0, 150.0, 92.0, 156.0  # radii of walls and of the prism's ends
A, B = 12.0, 2.0  # half axes of the ellipse, along the axis and round it
COUNT = 24


def prism(axis: int = 2, low: float = LOW, high: float = HIGH, te: EdgeKind = "round"):
    """An ellipse A x B, its long axis along the machine's, swept radially from low to high.

    A blunt trailing edge is had by letting the flow stop before it has turned half-way.
    """
    turn = 0.97 if te == "blunt" else 1.0
    spin = np.zeros((3, 3))
    spin[:2, :2] = turn * np.pi * np.array([[0.0, -1.0], [1.0, 0.0]])
    orbit = Orbit(spin, np.array([1.0, 0.0, 1.0]))
    sides = []
    for way in (1.0, -1.0):
        C = np.zeros((2, 3, 3))
        C[:, 0, axis] = -A
        C[:, 1, (axis + 2) % 3] = way * B
        C[:, 2, (axis + 1) % 3] = low, high
        sides.append(SideFit((orbit,), C))
    return BladeSurface(np.array([0.0, 1.0]), sides[0], sides[1], te=te)


def line(r: float, z: float = 60.0, count: int = 7):
    """A wall of constant radius."""
    return np.column_stack([np.linspace(-z, z, count), np.full(count, r)])


def row(axis: int = 2, count: int | None = COUNT, **said) -> BladeFile:
    """The prism with its walls."""
    walls = {"hub": line(HUB), "shroud": line(SHROUD)} | said
    machine = Machine("xyz"[axis], Row(count, walls["hub"], walls["shroud"]))
    return BladeFile("prism", prism(axis), machine)


def standing(blade: BladeFile, **said) -> BladeFile:
    """The same walls round another blade."""
    return replace(blade, **said)


def metal(gap: float = 0.0, steps: int = 4000) -> float:
    """Volume between both cylinders: sqrt(R^2 - y^2) - sqrt(r^2 - y^2) over the ellipse.

    Gauss-Chebyshev in y of the second kind, exact but for rounding.
    """
    k = np.arange(1, steps + 1)
    x = np.cos(np.pi * k / (steps + 1))
    w = np.pi / (steps + 1) * np.sin(np.pi * k / (steps + 1)) ** 2
    y = B * x
    height = np.sqrt((SHROUD - gap) ** 2 - y**2) - np.sqrt(HUB**2 - y**2)
    return float(2.0 * A * B * np.sum(w * height))
