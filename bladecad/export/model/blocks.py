"""A flow spelled out in blocks, so that any program with a matrix exponential can run it.

A block says: on the stretch `on` of t, the states `states` (first, one past the last) obey
z' = A z, and are `z` at `t0`; states that no block names there are zero. Each block starts where it
can be run from without overflow or loss: modes at their own edge, from where they decay, the
polynomial core half-way.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.polynomial import legendre

from bladecad.arrays import Array, Vector
from bladecad.fit.spectrum import Spectrum

Block = dict[str, object]


def blocks(spectrum: Spectrum) -> list[Block]:
    """Return the blocks of A: the core, once or in segments, then the LE and the TE modes."""
    core = _segments(spectrum) if len(spectrum.knots) else [_whole_core(spectrum)]
    return [*core, *_modes(spectrum)]


def _whole_core(spectrum: Spectrum) -> Block:
    size = spectrum.degree + 1
    return block(0, (0.0, 1.0), 0.5, spectrum.A[:size, :size], spectrum(np.array([0.5]))[0, :size])


def _segments(spectrum: Spectrum) -> list[Block]:
    """One block between two knots: the B-splines that live there obey a linear system of their own.

    Their pieces are N = M P with Legendre's polynomials P of the stretch, so N' = M D M^-1 N.
    """
    p, found = spectrum.degree, []
    D = spectrum.A[: p + 1, : p + 1]
    x = np.cos(np.pi * (np.arange(p + 1) + 0.5) / (p + 1))
    for a, b in pairwise([0.0, *spectrum.knots, 1.0]):
        t = 0.5 * (a + b) + 0.5 * (b - a) * np.append(x, 0.0)
        first = int(np.searchsorted(spectrum.core, t[-1], side="right")) - 1 - p
        N = spectrum(t)[:, first : first + p + 1]
        M = np.linalg.solve(legendre.legvander(x, p), N[:-1]).T
        A = np.linalg.solve(M.T, (M @ D).T).T / (b - a)
        found.append(block(first, (float(a), float(b)), float(t[-1]), A, N[-1]))
    return found


def _modes(spectrum: Spectrum) -> list[Block]:
    """One block a pair; they come last, in A as in the state."""
    found = []
    for t0, count, last in ((0.0, len(spectrum.le), len(spectrum.te)), (1.0, len(spectrum.te), 0)):
        z = spectrum(np.array([t0]))[0]
        for back in range(2 * (count + last), 2 * last, -2):
            i, k = spectrum.size - back, len(spectrum.A) - back
            A = spectrum.A[k : k + 2, k : k + 2]
            found.append(block(i, (0.0, 1.0), t0, A, z[i : i + 2]))
    return found


def block(first: int, on: tuple[float, float], t0: float, A: Array, z: Vector) -> Block:
    """Return one block, of the states from `first` on."""
    return {"states": [first, first + len(z)], "on": list(on), "t0": t0, "z": z, "A": A}
