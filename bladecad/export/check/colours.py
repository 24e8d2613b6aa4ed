"""The colours of deviation: blue where metal is missing, red where it stands out, pale at nominal.

Blue against orange-red is told apart by colour-blind eyes, and the ends differ in print from the
middle by their darkness.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from matplotlib.colors import LinearSegmentedColormap

from bladecad.arrays import Array, Vector
from bladecad.deviation.inspecting.inspection import Inspection

STOPS: Final = (
    (0.0, "#08306b"),
    (0.2, "#2a6fb5"),
    (0.4, "#9cc7e4"),
    (0.5, "#f6f3ea"),
    (0.6, "#f9c394"),
    (0.8, "#d9602b"),
    (1.0, "#7f1305"),
)
UNKNOWN: Final = "#8b9099"  # not measured
CAP: Final = "#d5d8dc"  # hub and tip, which are not inspected
INK, SOFT, BAND = "#1d2127", "#6b727b", "#2f7d4f"
GOOD, BAD = "#1f6b3a", "#a61b10"
MAP: Final = LinearSegmentedColormap.from_list("deviation", list(STOPS))
PALEST: Final = 0.3
WIDER: Final = 3.0  # than the widest band the scale is at most
TYPICAL: Final = 0.999  # of the points within the scale, if it may be so wide


def colours(deviation: Vector, limit: float) -> Array:
    """Return a colour for every deviation, (k, 3) of 0 to 1; beyond the limit that of the limit."""
    share = 0.5 + 0.5 * np.clip(deviation / limit, -1.0, 1.0)
    return np.asarray(MAP(share)[:, :3])


def line_share(deviation: Vector, limit: float) -> Vector:
    """Return places on the colour scale, 0 to 1, for thin lines: never so pale that they vanish."""
    share = np.clip(deviation / limit, -1.0, 1.0)
    return np.asarray(
        0.5 + 0.5 * np.where(share < 0.0, -1.0, 1.0) * np.maximum(np.abs(share), PALEST)
    )


def limit_of(inspection: Inspection) -> float:
    """Return the deviation, mm, at which the colours end: a round number beyond the widest band.

    It is wide enough for nearly all points, unless they are far out of the band.
    """
    bands = [zone.band for zone in inspection.zones]
    widest = max((max(band.upper, -band.lower) for band in bands), default=0.0)
    size = np.abs(inspection.feet.distance[~inspection.feet.rim])
    most = float(np.quantile(size, TYPICAL)) if len(size) else 0.0
    return round_up(max(widest, min(most, WIDER * widest or most)) or 1.0)


def round_up(x: float) -> float:
    """Return the next of 1, 1.5, 2, 3, 4, 5, 6, 8 times a power of ten."""
    ten = 10.0 ** np.floor(np.log10(x))
    steps = np.array([1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0])
    return float(f"{steps[steps * ten >= x * (1.0 - 1e-9)][0] * ten:.6g}")
