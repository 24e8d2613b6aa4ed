"""Is it a blade at all? Checks that need no geometry beyond the size."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from bladecad.data.loops import size
from bladecad.data.sections import MM_PER, Section, Sections
from bladecad.errors import DataError

FEWEST_SECTIONS = 2  # a surface needs two
FEWEST_POINTS = 8  # three on each side and the two edges
LARGEST, SMALLEST = 5000.0, 1.0  # mm: the last stages of steam turbines reach 1.8 m


def checked(sections: Sections) -> Sections:
    """Return the blade without repeated points, each repair noted.

    Raises
    ------
    DataError
        If there are too few sections or points, or the size is not that of a blade.
    """
    found = sections.sections
    if len(found) < FEWEST_SECTIONS:
        names = ", ".join(f'"{s.name}"' for s in found) or "none"
        raise DataError(
            f"{_file(sections)}: {len(found)} section ({names}), a surface needs at least "
            f"{FEWEST_SECTIONS}; give all sections of the blade"
        )
    single = [_without_repeats(section) for section in found]
    for section in single:
        _enough_points(section, _file(sections))
    _plausible_size(sections)
    notes = [
        f'section "{old.name}": {_points(len(old.points) - len(new.points))} repeated, dropped'
        for old, new in zip(found, single, strict=True)
        if len(new.points) < len(old.points)
    ]
    return replace(sections, sections=tuple(single)).noted(*notes)


def _without_repeats(section: Section) -> Section:
    points = section.points
    new = np.append(True, np.any(np.diff(points, axis=0) != 0, axis=1))[: len(points)]
    if new.all():
        return section
    place = np.cumsum(new) - 1
    le, te = (tuple(int(place[i]) for i in corners) for corners in (section.le, section.te))
    return replace(section, points=points[new], le=le, te=te)


def _enough_points(section: Section, file: str) -> None:
    if len(section.points) < FEWEST_POINTS:
        raise DataError(
            f'{file}: section "{section.name}" has {_points(len(section.points))}, '
            f"{FEWEST_POINTS} are needed; measure it again or leave the section out"
        )


def _plausible_size(sections: Sections) -> None:
    extent = size(np.vstack([s.points for s in sections.sections]))
    if SMALLEST <= extent <= LARGEST:
        return
    read_as = sections.source.unit
    likely = min(
        MM_PER, key=lambda unit: abs(np.log(extent / MM_PER[read_as] * MM_PER[unit] / 100))
    )
    raise DataError(
        f"{_file(sections)}: the blade is {extent / 1000:.4g} m large, blades are "
        f"{SMALLEST / 1000:g} to {LARGEST / 1000:g} m; wrong units? the numbers were "
        f"read as {read_as}, try --units {likely}"
    )


def _file(sections: Sections) -> str:
    return sections.source.path.name if sections.source.path else "sections"


def _points(n: int) -> str:
    return f"{n} point" if n == 1 else f"{n} points"
