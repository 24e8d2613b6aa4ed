"""Airfoils in closed form, whose camber line, thickness and edge radii are known exactly.

A section is the envelope of circles of radius rho(s) about a camber line M(s), s in [0, L]:

    X = M - rho rho' t +- rho sqrt(1 - rho'^2) n,
    rho' = (1 - a) c^p + a c + e (1 - c^2),    c = 1 - 2 s/L

M is therefore the camber line of inscribed circles and 2 rho the thickness, without approximation.
rho' is 1 at one end and -1 at the other, where the envelope closes: the end circles are the circles
of curvature of the edges. With c = cos(phi) the loop is an analytic function of phi.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from bladecad.arrays import Array, Points, Vector
from bladecad.errors import DataError

EDGE_POWER = 61  # p: rho' has fallen to 1/e within L/2p of the edge, two edge radii or so


@final
@dataclass(frozen=True)
class Profile:
    """One section by its design numbers, lengths in mm and angles in radians.

    height    : radius of the section, its place along the stacking axis
    length    : of the camber line, a circular arc, between the centres of the edge circles
    turning   : angle by which the camber line turns
    stagger   : angle between its straight connection and the machine axis
    thickness : largest inscribed circle at half length, a diameter
    radius_le, radius_te : of curvature at the edges
    """

    height: float
    length: float = 55.0
    turning: float = 0.4
    stagger: float = 0.8
    thickness: float = 3.0
    radius_le: float = 0.2
    radius_te: float = 0.2

    def __post_init__(self) -> None:
        if not 0 < self._bow < 1:
            raise DataError(
                f"thickness {self.thickness} mm does not suit length {self.length} mm and edge "
                f"radii {self.radius_le}, {self.radius_te} mm: a = {self._bow:.3f}, not in 0 to 1"
            )

    @property
    def _lean(self) -> float:
        return 1.5 * (self.radius_te - self.radius_le) / self.length

    @property
    def _bow(self) -> float:
        rise = (self.thickness - self.radius_le - self.radius_te) / self.length
        return (rise - 1 / (EDGE_POWER + 1)) / (1 / 2 - 1 / (EDGE_POWER + 1))

    def rate(self, s: Vector) -> Vector:
        """Return rho'(s)."""
        c, a = 1 - 2 * s / self.length, self._bow
        rate: Vector = (1 - a) * c**EDGE_POWER + a * c + self._lean * (1 - c**2)
        return rate

    def half_thickness(self, s: Vector) -> Vector:
        """Return rho(s), mm, the radius of the inscribed circle about the camber line."""
        c, a, p = 1 - 2 * s / self.length, self._bow, EDGE_POWER + 1
        rise = (1 - a) * (1 - c**p) / p + a * (1 - c**2) / 2
        lean = self._lean * (2 / 3 - c + c**3 / 3)
        return self.radius_le + self.length / 2 * (rise + lean)

    def camber(self, s: Vector) -> Array:
        """Return the camber line M(s) in the frame of its chord, (n, 2), mm; suction side up."""
        half = self.turning * s / self.length / 2
        arc = s * np.sinc(half / np.pi) * np.exp(1j * (self.turning / 2 - half))
        return np.column_stack([arc.real, arc.imag])

    def outline(self, phi: Vector) -> Array:
        """Return the loop in the same frame, (n, 2), mm.

        phi runs from the leading edge, 0, along the suction side to the trailing edge, pi, and on.
        """
        s = self.length / 2 * (1 - np.cos(phi))
        rho, rate = self.half_thickness(s), self.rate(s)
        tangent = np.exp(1j * self.turning * (1 / 2 - s / self.length))
        across = np.sign(np.sin(phi)) * np.sqrt(np.maximum(1 - rate**2, 0))
        step = rho * (1j * across - rate) * tangent
        xy: Array = np.column_stack([step.real, step.imag])
        return self.camber(s) + xy

    def chord(self) -> float:
        """Return the distance between the leading and the trailing edge, mm."""
        le, te = self.outline(np.array([0.0, np.pi]))
        return float(np.linalg.norm(te - le))

    def place(self, flat: Array) -> Points:
        """Put points of the chord frame in space: x the height, y tangential, z axial."""
        l, h = (flat - self.camber(np.array([self.length / 2]))).T  # noqa: E741
        y = l * np.sin(self.stagger) + h * np.cos(self.stagger)
        z = l * np.cos(self.stagger) - h * np.sin(self.stagger)
        return np.column_stack([np.full(len(y), self.height), y, z])
