"""What neighbouring residuals say: how much is noise, and how much they have in common."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Mask, Vector
from bladecad.deviation.nearest.feet import Feet
from bladecad.scans.fitting.robust import MAD

STRIPS: Final = 0.7  # of the usual spacing of points: width of the strips that are walked along
ZONES: Final = (0.02, 0.98)  # t between which is the body, beside the edges
EXACT: Final = 1e-9  # mm, of distances
CHANCE: Final = 2.0  # standard errors
FEWEST: Final = 400  # pairs that tell a correlation


@final
@dataclass(frozen=True)
class Scatter:
    """Noise and lack of fit of residuals.

    noise       : sigma, mm, from differences of neighbours, which the surface cancels from
    excess      : rms of the residuals over the noise; 1 where nothing but noise is left
    correlation : of neighbouring residuals, the largest of body, leading and trailing edge, less
                  what may be chance
    """

    noise: float
    excess: float
    correlation: float

    @property
    def lack(self) -> float:
        """Lack of fit over noise, both squared: the correlation is l^2 / (l^2 + sigma^2)."""
        return self.correlation / max(1.0 - self.correlation, EXACT)


def scatter(feet: Feet, counts: Mask, used: float = 0.0) -> Scatter:
    """Tell noise and lack of fit apart.

    A residual is r = noise + lack of fit, and neighbours share the second: sigma is
    1.48 MAD(r_i - r_j) / sqrt(2), whatever the fit; E r_i r_j over E r^2 is what the fit leaves,
    once what it has followed of the noise is added: its freedoms over the points.

    Parameters
    ----------
    feet : Feet
    counts : (k,) bool
        Points to use; outliers are left out.
    used : float
        Freedoms of the fit over the points it was fitted to.
    """
    first, second = pairs(feet, np.flatnonzero(counts))
    r = feet.distance
    noise = float(MAD * np.median(np.abs(r[first] - r[second])) / np.sqrt(2.0))
    rms = float(np.sqrt(np.mean(r[counts] ** 2)))
    zone = np.searchsorted(ZONES, feet.t[first])
    found = [_correlation(r[first[zone == z]], r[second[zone == z]]) for z in range(3)]
    return Scatter(noise, rms / max(noise, EXACT), max(found) + used)


def pairs(feet: Feet, which: NDArray[np.intp]) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Pairs of points that are neighbours on the blade, each point in two of them at most.

    Walked along strips of constant span, on either side.
    """
    strips = max(int(np.sqrt(len(which)) / STRIPS / 2.0), 1)
    strip = np.minimum((feet.u[which] * strips).astype(np.int64), strips - 1)
    strip = 2 * strip + feet.suction[which]
    order = np.argsort(strip + 0.5 * feet.t[which], kind="stable")
    ordered, same = which[order], np.diff(strip[order]) == 0
    return ordered[:-1][same], ordered[1:][same]


def _correlation(a: Vector, b: Vector) -> float:
    if len(a) < FEWEST or not np.any(a):
        return 0.0
    found = float(2.0 * np.mean(a * b) / (np.mean(a * a) + np.mean(b * b)))
    return found - float(CHANCE / np.sqrt(len(a)))


def of_the_airfoil(feet: Feet) -> Mask:
    """Points whose foot lies on a side, not on the face of a cut-off edge nor beyond the span."""
    return np.asarray((feet.face < 2) & ~feet.rim)
