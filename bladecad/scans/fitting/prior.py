"""How rough a surface is taken to be: third differences of its poles, from the surface itself."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from bladecad.arrays import Array, Vector
from bladecad.scans.fitting.freedom import Freedom, Pair, local_poles
from bladecad.scans.fitting.robust import MAD
from bladecad.surface.blade import BladeSurface

ALONG_U: Final = 0.1
ALONG_T: Final = 0.3  # of the weight that Bayes gives to the prior: it shall not pull
MEDIAN: Final = MAD**2  # of squares, to their mean
SMOOTHEST: Final = 1e-3  # of the noise: no prior is sharper


class Roughness(NamedTuple):
    """Weights of squared third differences of the local poles, for unit weight of a point.

    along_u : (nt,) float a side
    along_t : (nt - 3,) float a side
    """

    along_u: Pair
    along_t: Pair

    def times(self, factor: float) -> Roughness:
        """The same, weighed more or less."""
        u, t = (Pair(factor * w.suction, factor * w.pressure) for w in self)
        return Roughness(u, t)


def roughness(surface: BladeSurface, free: Freedom, noise: float) -> Roughness:
    """Weigh smoothness as its own size tells: sigma^2 / tau^2, tau the rms third difference.

    Empirical Bayes: where points are many it does nothing, in holes and at thinly covered edges it
    carries the surface on as smoothly as it is elsewhere.

    Parameters
    ----------
    surface : BladeSurface
        Close to what is looked for.
    free : Freedom
    noise : float
        sigma of the points, mm.
    """
    poles = local_poles(surface, free)
    along_u = [ALONG_U * _weight(np.diff(c, 3, axis=0), (0, 2), noise) for c in poles]
    along_t = [ALONG_T * _weight(np.diff(c, 3, axis=1), (0, 2), noise) for c in poles]
    return Roughness(Pair(along_u[0], along_u[1]), Pair(along_t[0], along_t[1]))


def _weight(differences: Array, axes: tuple[int, int], noise: float) -> Vector:
    tau2 = MEDIAN * np.median(differences**2, axis=axes)  # hub and tip, where points end, are wild
    return np.asarray(noise**2 / np.maximum(tau2, (SMOOTHEST * noise) ** 2))
