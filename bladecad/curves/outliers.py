"""Misprints and spikes: points that their neighbours deny."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import final

import numpy as np

from bladecad.arrays import Vector
from bladecad.curves.judged import REACH, Group, Judged
from bladecad.curves.repair import signed_area
from bladecad.curves.residuals import MAD, Mask
from bladecad.data.sections import Section, Sections

NEARBY = 6.0  # times the usual residual nearby: gaussian noise reaches 4.4 in 40,000 points
BESIDE = 3.5  # times the residual at the same place of the sections beside it
ALONE = 2.2  # times what is left of the residuals beside it once the point is left out
CLEAR = 6e-4  # of the size: least offset, times its ratio to what is left beside it
SMALLEST = 2e-5  # of the size: 1 um on 50 mm
MOST = 0.05  # of the points of a section; more is no matter of single points
TINY = 1e-9  # of the size: below it residuals are rounding
SHADOW = 0.25  # of a misprint: what it may do to a smoothed neighbour


@final
@dataclass(frozen=True)
class Misprint:
    """A point that does not fit its neighbours.

    section, number : name of the section, its number, 0 at the hub
    index  : number of the point in the section, from 0
    offset : mm across the outline, positive outwards, from the cubic through its neighbours
    scale  : mm; what residuals reach beside it once it is left out
    """

    section: str
    number: int
    index: int
    offset: float
    scale: float

    def __str__(self) -> str:
        return (
            f'section "{self.section}", point {self.index + 1}: {self.offset:+.3g} mm off the '
            f"line of its neighbours, which agree within {self.scale:.2g} mm"
        )


def misprints(sections: Sections) -> tuple[Misprint, ...]:
    """Name the points that do not fit their neighbours, section by section.

    A point is left out and predicted by the cubic through two neighbours on either side. It is
    named where that residual stands out against (a) the residuals nearby, (b) those at the same
    place of the sections beside it, where edges are as hard to predict, and (c) those of its
    neighbours without it. By (c) a spike is told from its neighbours, whose residuals it spoils,
    and from stretches that are rough as a whole. Worst first; named points judge no others.
    """
    loops = [Judged.of(section, sections.axis) for section in sections.sections]
    while worst := [(k, group) for k in range(len(loops)) if (group := _worst(loops, k))]:
        for k, group in worst:
            loops[k] = loops[k].without(group)
    return tuple(
        _misprint(loop, k, int(i))
        for k, loop in enumerate(loops)
        for i in np.flatnonzero(~loop.keep)
    )


def keep_masks(sections: Sections, found: Sequence[Misprint]) -> list[Mask]:
    """Return for each section which points to use, as `split_sides(keep=...)` takes them."""
    masks = [np.ones(len(section.points), dtype=bool) for section in sections.sections]
    for one in found:
        masks[one.number][one.index] = False
    return masks


def noise(sections: Sections) -> float:
    """Return an estimate of the scatter of the points across the outline, mm, one sigma.

    The robust scale of the residuals of `misprints`, median over the sections. On smooth data of
    coarse spacing it is an upper bound: the cubic misses the curve by more than the points do.
    """
    return float(np.median([_scatter(section, sections.axis) for section in sections.sections]))


def _worst(loops: Sequence[Judged], k: int) -> Group:
    """Return the point of section k that stands out most, or two side by side; () if none does."""
    loop, found = loops[k], loops[k].residuals
    bound = np.max([NEARBY * found.usual, BESIDE * _beside(loops, k), SHADOW * loop.shadow], axis=0)
    suspects = np.flatnonzero(found.away > np.maximum(bound, SMALLEST * loop.size))
    if np.count_nonzero(~loop.keep) >= MOST * len(loop.keep):
        return ()
    singles = [(int(i),) for i in suspects]
    pairs = [(int(i), int(j)) for i, j in pairwise(suspects) if j == i + 1]
    return _clearest(loop, singles) or _clearest(loop, pairs)


def _clearest(loop: Judged, groups: Sequence[Group]) -> Group:
    """Return the group that stands out most against what is left beside it, () if none does."""
    best: Group = ()
    most = CLEAR * loop.size
    for group in groups:
        away, left = float(loop.residuals.away[list(group)].min()), _left(loop, group)
        if away > ALONE * left and away**2 / left > most:
            best, most = group, away**2 / left
    return best


def _left(loop: Judged, group: Group) -> float:
    """What the neighbours of a group show without it, in the terms of its own residual."""
    near = np.arange(group[0] - REACH, group[-1] + REACH + 1) % len(loop.keep)
    left = loop.without(group).residuals.rough[near].max() * loop.residuals.gain[group[0]]
    return max(float(left), TINY * loop.size)


def _beside(loops: Sequence[Judged], k: int) -> Vector:
    """Residuals at the same place of the two nearest sections, the smaller of both, (n,)."""
    near = sorted((j for j in range(len(loops)) if j != k), key=lambda j: abs(j - k))[:2]
    same = [loops[j].residuals.rough[loops[j].tree.query(loops[k].places, k=3)[1]] for j in near]
    if not same:
        return np.zeros(len(loops[k].keep))
    return np.asarray(
        np.min([rough.max(axis=1) for rough in same], axis=0) * loops[k].residuals.gain
    )


def _misprint(loop: Judged, number: int, i: int) -> Misprint:
    outwards = -1.0 if signed_area(loop.flat.points) > 0 else 1.0
    scale = max(float(loop.residuals.usual[i]), _left(loop, (i,)))
    return Misprint(loop.section.name, number, i, outwards * loop.offset(i), scale)


def _scatter(section: Section, axis: int) -> float:
    found = Judged.of(section, axis).residuals
    judged = found.away > 0
    return (
        MAD * float(np.median(np.abs(found.offset / found.gain)[judged])) if judged.any() else 0.0
    )
