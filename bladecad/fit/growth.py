"""Pairs of modes put where they help most, and taken away where they are missed least."""

from __future__ import annotations

from itertools import product
from typing import Final, NamedTuple

import numpy as np

from bladecad.arrays import Array, Vector
from bladecad.fit.best_linear import BestLinear, best_linear
from bladecad.fit.projection import LOG_A, project, reach
from bladecad.fit.spectrum import Spectrum, pairs

RATES: Final = 15  # tried at each edge, evenly in log a
STIFFNESS: Final = (-0.8, -0.3, 0.5, 2.0, 6.0, 15.0)  # tried with each of them
SETTLING: Final = 6  # steps that all pairs take together after each new one
NEW: Final = 1e-7  # share of a mode that must stand out from those there are
NO_PAIRS: Final = np.empty((0, 2))


class Trials(NamedTuple):
    """Pairs that may be put at one edge.

    pairs : (c, 2) float, a and k
    modes : (c, N, 2) float, each of length one
    """

    pairs: Array
    modes: Array


def grown(le: int, te: int, degree: int, t: Vector, Y: Array) -> Spectrum:
    """Begin with the core alone and put pairs where they take most from the residual, one by one.

    Parameters
    ----------
    le, te : int
        Pairs there shall be at either edge; which edge is next, the data say.
    degree : int
    t : (N,) float
    Y : (N, d) float
        All sections side by side.

    Returns
    -------
    Spectrum
        A start for `project`: after each new pair all of them have moved, but not to the end.
    """
    spectrum, trials = Spectrum(degree, NO_PAIRS, NO_PAIRS), _trials(t)
    while (len(spectrum.le), len(spectrum.te)) != (le, te):
        wanted = (len(spectrum.le) < le, len(spectrum.te) < te)
        spectrum = _with_one_more(best_linear(spectrum, t, Y), trials, wanted)
        (spectrum,) = project(spectrum, t, [Y], steps=SETTLING)
    return spectrum


def shrunk(found: Spectrum, le: int, te: int, degree: int, t: Vector, Y: Array) -> Spectrum:
    """Take pairs away, those first without which the others do best where they are."""
    spectrum = Spectrum(degree, found.le, found.te, found.knots)
    while (len(spectrum.le), len(spectrum.te)) != (le, te):
        spectrum = min(_with_one_less(spectrum, le, te), key=lambda s: best_linear(s, t, Y).rss)
    return spectrum


def _trials(t: Vector) -> tuple[Trials, Trials]:
    """What may be put at the leading and at the trailing edge, no faster than the samples tell."""
    le, te = (
        np.array(list(product(np.exp(np.linspace(LOG_A[0], fastest, RATES)), STIFFNESS)))
        for fastest in reach(t)
    )
    return Trials(le, _unit_modes(le, t)), Trials(te, _unit_modes(te, 1.0 - t))


def _unit_modes(rates: Array, t: Vector) -> Array:
    modes = pairs(rates, t)
    return np.asarray(modes / np.linalg.norm(modes, axis=1, keepdims=True))


def _with_one_more(
    best: BestLinear, trials: tuple[Trials, Trials], wanted: tuple[bool, bool]
) -> Spectrum:
    gains = [
        (*_largest_gain(best, own.modes), end) for end, own in enumerate(trials) if wanted[end]
    ]
    _, i, end = max(gains)
    s, new = best.spectrum, trials[end].pairs[[i]]
    le, te = (s.le, np.vstack([s.te, new])) if end else (np.vstack([s.le, new]), s.te)
    return Spectrum(s.degree, le, te, s.knots)


def _largest_gain(best: BestLinear, modes: Array) -> tuple[float, int]:
    """How much the best of some pairs takes from the sum of squares, rates as they are; which."""
    N = modes.shape[1]
    Q, residual = best.Q[:N], best.residual[:N]
    D = modes - Q @ (Q.T @ modes)
    U, R = np.linalg.qr(D - Q @ (Q.T @ D))
    new = np.abs(np.diagonal(R, axis1=1, axis2=2)) > NEW
    gains = (((np.swapaxes(U, 1, 2) @ residual) ** 2).sum(axis=2) * new).sum(axis=1)
    return float(gains.max()), int(gains.argmax())


def _with_one_less(s: Spectrum, le: int, te: int) -> list[Spectrum]:
    """Every spectrum with one pair less, at an edge that has more than there shall be."""
    at_le = range(len(s.le)) if len(s.le) > le else ()
    at_te = range(len(s.te)) if len(s.te) > te else ()
    return [
        *(Spectrum(s.degree, np.delete(s.le, i, axis=0), s.te, s.knots) for i in at_le),
        *(Spectrum(s.degree, s.le, np.delete(s.te, i, axis=0), s.knots) for i in at_te),
    ]
