"""What of a scan goes on beyond hub and tip like a blade, though its slices were not taken."""

from __future__ import annotations

from typing import Final

import numpy as np

from bladecad.arrays import Points
from bladecad.scans.finding.located import Located

NEAR: Final = 0.2  # of the chord, from the camber line and beyond the edges
MOSTLY: Final = 0.95  # of the points so near: neither root nor platform nor shroud
FEWEST: Final = 100  # points
MUCH: Final = 0.08  # of the span: less is a rim that is not cut across


def left_beyond(points: Points, found: Located) -> tuple[str, ...]:
    """Say how far a blade goes on beyond what was taken of it.

    Parameters
    ----------
    points : (k, 3) float, mm
        Of the skin of the scan.
    found : Located
    """
    flat = found.flat(points)
    X, across, _, chord = found.shape.off(flat)
    near = (np.abs(across) < NEAR * chord) & (np.abs(X - 0.5) < 0.5 + NEAR)
    notes = []
    for where, off in (("below", found.low - flat[:, 2]), ("above", flat[:, 2] - found.high)):
        beyond = off > 0.0
        far = float(off.max())
        if far < MUCH * (found.high - found.low) or beyond.sum() < FEWEST:
            continue
        if near[beyond].mean() > MOSTLY:
            notes.append(
                f"the scan goes on for {far:.4g} mm {where} what was taken, much like a blade, but "
                "not in closed slices that follow the others; give --span to take more, or --about "
                "where hub and tip are round"
            )
    return tuple(notes)
