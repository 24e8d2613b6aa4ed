"""The periodic faces: the mean camber surface, continued to inlet and outlet, half a pitch away."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from numpy.polynomial import legendre

from bladecad.arrays import Array, Points, Vector, frozen, seal
from bladecad.errors import GeometryError
from bladecad.passage.channel import SIDES, Channel
from bladecad.passage.cylinder import to_cylinder
from bladecad.passage.trim import Trimmed

DEGREES: Final = (4, 5)  # degrees of the mean camber surface
NODES, WEIGHTS = np.polynomial.legendre.leggauss(12)
SPREAD: Final = 0.5  # of the blade's m: over so much the camber's slope fades ahead and behind


@final
@dataclass(frozen=True, eq=False)
class Camber:
    """theta(sigma, v) of the mean camber surface and its continuation.

    C : (5, 6) float, radians, Legendre coefficients over the blade
    """

    channel: Channel
    C: Array

    def __post_init__(self) -> None:
        seal(self, C=(None, None))

    def __call__(self, sigma: Vector, v: Vector) -> Vector:
        """Angle at the places (sigma_k, v_k), radians.

        Notes
        -----
        Beyond the edges theta = theta_e + k L (1 - exp(-d / L)), with k = dtheta/dm at the edge,
        d the distance from it in m = integral of ds / r, and L half the blade's m: the tangent is
        kept, and the whole turn stays below k L.
        """
        on = np.clip(sigma, 1.0, 2.0)
        theta = self._on_blade(on, v)
        d = self._m(on, sigma, v)
        half = SPREAD * self._m(np.ones_like(v), np.full_like(v, 2.0), v)
        k = self._slope(on, v)
        return np.asarray(theta + np.sign(d) * k * half * -np.expm1(-np.abs(d) / half))

    def _on_blade(self, sigma: Vector, v: Vector) -> Vector:
        return np.asarray(legendre.legval2d(2.0 * sigma - 3.0, 2.0 * v - 1.0, self.C))

    def _slope(self, sigma: Vector, v: Vector) -> Vector:
        """dtheta/dm along v = const, on the blade's side of the edges."""
        dC = legendre.legder(self.C, axis=0)
        by_sigma = 2.0 * legendre.legval2d(2.0 * sigma - 3.0, 2.0 * v - 1.0, dC)
        return np.asarray(by_sigma / self._rate(np.clip(sigma, 1.0, 2.0 - 1e-9), v))

    def _rate(self, sigma: Vector, v: Vector) -> Vector:
        """dm/dsigma."""
        along, _ = self.channel.slopes(sigma, v)
        return np.asarray(np.linalg.norm(along, axis=1) / self.channel(sigma, v)[:, 1])

    def _m(self, start: Vector, stop: Vector, v: Vector) -> Vector:
        """Integral of ds / r along v = const, within one piece of sigma."""
        half = 0.5 * (stop - start)
        sigma = start[:, None] + half[:, None] * (1.0 + NODES)
        rate = self._rate(sigma.ravel(), np.repeat(v, len(NODES))).reshape(sigma.shape)
        return np.asarray(half * (rate @ WEIGHTS))


def camber_of(blade: Trimmed, channel: Channel, angle: float) -> Camber:
    """Fit the mean camber surface: half the sum of both sides at equal t, least squares.

    angle : radians, somewhere on the blade
    """
    t, v = np.linspace(0.01, 0.99, 61), np.linspace(0.0, 1.0, 25)
    places = [x.ravel() for x in np.meshgrid(v, t, indexing="ij")]
    mean = np.mean([to_cylinder(blade.at(s, *places), blade.axis, angle) for s in SIDES], axis=0)
    sigma, across = channel.locate(mean[:, :2])
    M = legendre.legvander2d(2.0 * sigma - 3.0, 2.0 * across - 1.0, list(DEGREES))
    C = np.linalg.lstsq(M, mean[:, 2], rcond=None)[0].reshape(DEGREES[0] + 1, DEGREES[1] + 1)
    return Camber(channel, frozen(C))


def clearance(points: Points, camber: Camber, axis: int, angle: float, pitch: float) -> float:
    """Least distance in the direction of rotation of blade points from the periodic faces, mm.

    Raises
    ------
    GeometryError
        If the blade and a periodic face cross, or it reaches beyond inlet or outlet.
    """
    zrt = to_cylinder(points, axis, angle)
    sigma, v = camber.channel.locate(zrt[:, :2])
    _check_between(zrt, sigma)
    away = zrt[:, 2] - camber(sigma, v)
    free = zrt[:, 1] * (0.5 * pitch - np.abs(away))
    k = int(np.argmin(free))
    if free[k] <= 0.0:
        raise GeometryError(
            f"the blade crosses its periodic face by {-free[k]:.4g} mm at axial position "
            f"{zrt[k, 0]:.5g} mm, radius {zrt[k, 1]:.5g} mm: a pitch of "
            f"{np.degrees(pitch):.4g} degrees is too narrow for it; look at the blade count"
        )
    return float(free[k])


def _check_between(zrt: Points, sigma: Vector) -> None:
    for k, name, edge in (
        (int(sigma.argmin()), "inlet", "leading"),
        (int(sigma.argmax()), "outlet", "trailing"),
    ):
        if not 0.0 < sigma[k] < 3.0:
            raise GeometryError(
                f"the blade reaches beyond the {name} at axial position {zrt[k, 0]:.5g} mm, radius "
                f"{zrt[k, 1]:.5g} mm, for its {edge} edge is bowed; give a larger --{name}"
            )
