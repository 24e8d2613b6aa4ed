"""The paper's segmental technology: every line cut into pieces, each the flow of its own system."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from bladecad.arrays import Lines, Vector
from bladecad.fit.samples import Samples
from bladecad.replay.curves import Curves
from bladecad.replay.subject import FITTED, JUDGED, Stretch
from bladecad.replay.trajectory import STARTS, followed

FEWEST = 3  # gaps in a piece


def segmented(stretch: Stretch, segments: int) -> Curves:
    """Cut every line at equal numbers of gaps and fit each piece on the trajectory.

    The pieces are not held together: what they miss at a cut is in the error, and a step.
    """
    gaps = len(stretch.t) - 1
    cuts = np.linspace(0, gaps, min(segments, gaps // FEWEST) + 1).round().astype(int)
    pairs = pairwise(cuts)
    pieces = [_piece(stretch, int(a), int(b)) for a, b in pairs]
    dense = np.concatenate([pieces[0], *[piece[:, 1:] for piece in pieces[1:]]], axis=1)
    return Curves(dense[:, ::JUDGED], dense)


def _piece(stretch: Stretch, a: int, b: int) -> Lines:
    """The fit from point a to point b, where it is judged."""
    fitted = slice(a * FITTED, b * FITTED + 1)
    samples = Samples(_own(stretch.fitted.t[fitted]), stretch.fitted.points[:, fitted])
    judged = stretch.judged.t[a * JUDGED : b * JUDGED + 1]
    return followed(samples, _own(judged), STARTS[:1])


def _own(t: Vector) -> Vector:
    """Parameters from 0 to 1 on a piece."""
    return np.asarray((t - t[0]) / (t[-1] - t[0]))
