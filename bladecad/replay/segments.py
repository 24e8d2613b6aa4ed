"""The paper's segmental technology: every line cut into pieces, each the flow of its own system."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from bladecad.replay.curves import Curves
from bladecad.replay.subject import JUDGED, Stretch
from bladecad.replay.trajectory import STARTS, on_trajectory

FEWEST = 3  # gaps in a piece


def segmented(stretch: Stretch, segments: int) -> Curves:
    """Cut every line at equal numbers of gaps and fit each piece on the trajectory.

    The pieces are not held together: what they miss at a cut is in the error, and a step.
    """
    gaps = len(stretch.t) - 1
    cuts = np.linspace(0, gaps, min(segments, gaps // FEWEST) + 1).round().astype(int)
    pairs = pairwise(cuts)
    pieces = [on_trajectory(_piece(stretch, int(a), int(b)), STARTS[:1]).between for a, b in pairs]
    dense = np.concatenate([pieces[0], *[piece[:, 1:] for piece in pieces[1:]]], axis=1)
    return Curves(dense[:, ::JUDGED], dense)


def _piece(stretch: Stretch, a: int, b: int) -> Stretch:
    """The stretch from point a to point b."""
    begin, end = stretch.t[a], stretch.t[b]
    whole = stretch.last - stretch.first
    first, last = (stretch.first + whole * float(t) for t in (begin, end))
    t = (stretch.t[a : b + 1] - begin) / (end - begin)
    return replace(stretch, first=first, last=last, t=np.append(t[:-1], 1.0))
