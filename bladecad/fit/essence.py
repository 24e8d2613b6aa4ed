"""What the rates of the modes can feel of the data: neither place nor pose, nor rounding."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.linalg import svd

from bladecad.arrays import Array, Vector
from bladecad.fit.samples import Samples, by_section

GRAIN = 1e-8  # of the size: finer than any point is known, coarser than any rounding


class Essence(NamedTuple):
    """The samples of one side as the search for rates takes them.

    t        : (N,) float
    together : (N, q) float, all sections side by side
    apart    : (N, q) float a section
    """

    t: Vector
    together: Array
    apart: Sequence[Array]


def essence(samples: Samples) -> Essence:
    """Reduce samples to what variable projection depends on.

    Notes
    -----
    min_C |Phi C - Y|^2 depends on Y through Y Y^T alone: with Y = U s V^T the columns of U s do for
    Y, whatever the frame, the unit and the place of the blade. They are rounded to a grain, for the
    search runs through many nearly collinear columns and would carry the last digit of Y, where a
    moved blade differs, to another of its many minima. Rounded, the search is the same to the last
    bit, and moving and fitting is fitting and moving.
    """
    columns = samples.about(samples.centre)
    columns = columns / (np.linalg.norm(columns) / np.sqrt(columns.size / 3))
    return Essence(
        samples.t,
        _essential(columns),
        [_essential(own) for own in by_section(columns)],
    )


def _essential(Y: Array) -> Array:
    """U s of the singular value decomposition of Y, each column of a definite sign."""
    U, s, _ = svd(Y, full_matrices=False)
    U = (U * s)[:, s > GRAIN * np.sqrt(len(Y))]
    largest = U[np.abs(U).argmax(axis=0), np.arange(U.shape[1])]
    return _rounded(U * np.sign(largest), GRAIN)


def _rounded(values: Array, grain: float) -> Array:
    return np.asarray(np.round(values / grain) * grain)
