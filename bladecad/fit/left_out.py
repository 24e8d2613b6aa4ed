"""What the points can say at all: the error at every second point when it is left out."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from bladecad.arrays import Mask, Points, Vector
from bladecad.curves.sides import BladeLines
from bladecad.data.sections import Sections
from bladecad.fit.blade import BladeFit
from bladecad.fit.modal import fit_spectra, prepare
from bladecad.fit.sidefit import Basis
from bladecad.fit.spectrum import Spectrum

Masks = Sequence[Mask]
DENSE = 2001


class LeftOut(NamedTuple):
    """Distance of points from a blade fitted without them, mm."""

    largest: float
    rms: float
    points: int


def left_out(
    sections: Sections, fit: BladeFit, keep: Masks, split: Callable[[Masks], BladeLines]
) -> LeftOut:
    """Fit every second point with the spectra already found, and measure the others.

    The uncertainty of the sections themselves: where it is larger than the error of the fit, more
    points would say more, a higher order would not.

    Parameters
    ----------
    sections : Sections
    fit : BladeFit
        Modal or segmented.
    keep : sequence of (n,) bool
        Points that the fit itself used.
    split : callable
        Breaks the sections into sides, using the points of a mask only.
    """
    halves = [k & (np.arange(len(k)) % 2 == 0) for k in keep]
    suction, pressure = (_spectra(side.bases) for side in (fit.suction, fit.pressure))
    assert fit.order is not None
    half = fit_spectra(prepare(split(halves)), fit.order, suction, pressure, fit.tolerance)
    t = 0.5 - 0.5 * np.cos(np.pi * np.linspace(0.0, 1.0, DENSE))
    loops = np.concatenate([half.suction(t), half.pressure(t)[:, ::-1]], axis=1)
    away = [
        _distance(section.points[k & ~h], loop)
        for section, k, h, loop in zip(sections.sections, keep, halves, loops, strict=True)
    ]
    d = np.concatenate(away)
    return LeftOut(float(d.max()), float(np.sqrt(np.mean(d**2))), len(d))


def _spectra(bases: Sequence[Basis]) -> tuple[Spectrum, ...]:
    return tuple(b for b in bases if isinstance(b, Spectrum))


def _distance(points: Points, loop: Points) -> Vector:
    """Distance of points from a dense line: from the two pieces beside the nearest vertex, (k,)."""
    near = cKDTree(loop).query(points)[1]
    pieces = []
    for step in (-1, 1):
        a, b = loop[near], loop[np.clip(near + step, 0, len(loop) - 1)]
        d = b - a
        length = np.maximum(np.einsum("kx,kx->k", d, d), 1e-30)
        s = np.clip(np.einsum("kx,kx->k", points - a, d) / length, 0.0, 1.0)
        pieces.append(np.linalg.norm(a + s[:, None] * d - points, axis=1))
    return np.asarray(np.minimum(*pieces))
