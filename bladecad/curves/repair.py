"""Sections put in order from hub to tip; what no order mends is refused with its place."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from bladecad.arrays import Points, Vector
from bladecad.curves.develop import Flat, develop, frame
from bladecad.curves.plausible import refuse_crossings, refuse_gaps, refuse_sizes, refuse_turned
from bladecad.data.loops import size
from bladecad.data.sections import Section, Sections
from bladecad.errors import DataError

CLEAR_RISE = 0.5  # of the way between section centres: below it, radius does not tell the order
SAME_PLACE = 1e-4  # of the size of a section: 6 um on 60 mm


def repaired(sections: Sections, *, ordered: bool = False) -> Sections:
    """Return the sections in order from hub to tip, every repair noted.

    `ordered` says that they are: what was cut from one body, hub to tip, need not be told by its
    radius, and none of it can be turned against the rest.

    Raises
    ------
    DataError
        If a section crosses itself, has a gap, has another size than its neighbours, is turned
        round or mirrored against them, or lies where another one lies.
    """
    flats = [develop(section.points, sections.axis) for section in sections.sections]
    refuse_sizes(sections)
    for section, flat in zip(sections.sections, flats, strict=True):
        refuse_crossings(section, flat)
        refuse_gaps(section)
    if not ordered:
        sections, order = _in_order(sections)
        flats = [flats[i] for i in order]
        refuse_turned(sections, flats)
    return sections.noted(*_running_back(sections, flats))


def heights(sections: Sections) -> tuple[Vector, str]:
    """Return the place of each section along the span, mm, and what it was measured by.

    The mean radius about the machine axis where that tells sections apart, as it does on most
    machines; else, as on the vanes of a radial diffuser, the way along the line of their centres,
    counted in the direction of the file.
    """
    centres = np.array([_centre(section) for section in sections.sections])
    radii = np.array([_mean_radius(section, sections.axis) for section in sections.sections])
    middle, rows, _ = frame(centres)
    along = (centres - middle) @ rows[0]
    if np.ptp(radii) > CLEAR_RISE * np.ptp(along):
        return radii, "mean radius"
    return along * (1.0 if along[-1] >= along[0] else -1.0), "place along the stacking line"


def _in_order(sections: Sections) -> tuple[Sections, list[int]]:
    """Return the sections sorted by height, and the old numbers in the new order."""
    height, by = heights(sections)
    order = [int(i) for i in np.argsort(height, kind="stable")]
    _refuse_same_place(sections, height, order)
    if order == sorted(order):
        return sections, order
    falling = sum(b < a for a, b in pairwise(order)) * 2 > len(order) - 1
    found = sections.sections
    notes = ["the sections ran from tip to hub; turned round"] if falling else []
    if strays := sorted(set(order) - _longest_run(order[::-1] if falling else order)):
        names = ", ".join(f'"{found[i].name}"' for i in strays)
        notes.append(f"out of order along the span: section {names}; sorted by {by}")
    return replace(sections, sections=tuple(found[i] for i in order)).noted(*notes), order


def _refuse_same_place(sections: Sections, height: Vector, order: list[int]) -> None:
    for i, j in pairwise(order):
        first, second = sections.sections[i], sections.sections[j]
        apart = height[j] - height[i]
        if apart <= SAME_PLACE * size(first.points):
            raise DataError(
                f'sections "{first.name}" and "{second.name}" lie {apart:.3g} mm apart along the '
                "span, so no surface leads from one to the other; leave one of them out"
            )


def _longest_run(order: list[int]) -> set[int]:
    """Return the members of the longest rising subsequence: those that may stay where they are."""
    runs: list[tuple[int, ...]] = [()]
    for i in order:
        lower = [run for run in runs if not run or run[-1] < i]
        runs.append((*_longest(lower), i))
    return set(_longest(runs))


def _longest(runs: list[tuple[int, ...]]) -> tuple[int, ...]:
    return runs[int(np.argmax([len(run) for run in runs]))]


def _running_back(sections: Sections, flats: list[Flat]) -> list[str]:
    """Return a note on sections that run the other way round than most."""
    ways = np.array([signed_area(flat.points) > 0 for flat in flats])
    odd = np.flatnonzero(ways != (2 * ways.sum() >= len(ways)))
    names = ", ".join(f'"{sections.sections[i].name}"' for i in odd)
    note = f"runs the other way round than most: section {names}; put right"
    return [note] if names else []


def signed_area(loop: Points) -> float:
    """Return the area of a flat loop, positive if it runs counter-clockwise."""
    x, y = loop.T
    return 0.5 * float(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def _weights(section: Section) -> Vector:
    """Return for every point the length of outline it stands for."""
    d = np.linalg.norm(np.roll(section.points, -1, axis=0) - section.points, axis=1)
    return np.asarray(d + np.roll(d, 1))


def _centre(section: Section) -> Points:
    return np.average(section.points, axis=0, weights=_weights(section))


def _mean_radius(section: Section, axis: int) -> float:
    radii = np.linalg.norm(np.delete(section.points, axis, axis=1), axis=1)
    return float(np.average(radii, weights=_weights(section)))
