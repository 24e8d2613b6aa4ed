"""What a file says, before options, defaults and checks; and how it settles into millimetres."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TypeVar, final

import numpy as np

from bladecad.arrays import Array
from bladecad.data.sections import (
    MM_PER,
    Axis,
    Origin,
    Row,
    Section,
    Sections,
    Source,
    Unit,
)

T = TypeVar("T")
Z: Axis = "z"


@final
@dataclass(frozen=True, eq=False)
class Draft:
    """What a file says, in its own unit.

    unit, axis  : None where the file does not say
    hub, shroud : (n, 3) points, or (n, 2) axial position and radius
    cylindrical : True where the file gives radii and angles, so that any axis will do;
                  `sections` then stand about z
    usual       : the unit taken where neither the file nor the user says one
    """

    format: str
    sections: tuple[Section, ...]
    unit: Unit | None = None
    axis: Axis | None = None
    blade_count: int | None = None
    hub: Array = field(default_factory=lambda: np.empty((0, 2)))
    shroud: Array = field(default_factory=lambda: np.empty((0, 2)))
    cylindrical: bool = False
    notes: tuple[str, ...] = ()
    usual: Unit = "mm"

    def noted(self, *notes: str) -> Draft:
        """Return the same draft with further notes for the user."""
        return replace(self, notes=self.notes + notes)


def settle(draft: Draft, path: Path, unit: Unit | None, axis: Axis | None) -> Sections:
    """Turn a draft into sections in mm; an option wins over the file, the file over the default."""
    in_unit, unit_from, unit_notes = choose("unit", "--units", draft.unit, unit, draft.usual)
    axis_said = None if draft.cylindrical and axis else draft.axis
    about, axis_from, axis_notes = choose("axis", "--axis", axis_said, axis, Z)
    column = "xyz".index(about)
    turn = column - 2 if draft.cylindrical else 0
    scale = MM_PER[in_unit]
    row = Row(
        draft.blade_count,
        hub=_meridional(draft.hub, column) * scale,
        shroud=_meridional(draft.shroud, column) * scale,
    )
    sections = tuple(
        replace(s, points=np.roll(s.points, turn, axis=1) * scale) for s in draft.sections
    )
    notes = (*draft.notes, *unit_notes, *axis_notes)
    source = Source(path, draft.format, in_unit, unit_from, about, axis_from, notes)
    return Sections(sections, source, row)


def choose(
    what: str, flag: str, said: T | None, asked: T | None, default: T
) -> tuple[T, Origin, tuple[str, ...]]:
    """Return what holds, who said so, and notes; an option wins over the file."""
    if asked is not None:
        clash = f"the file says {what} {said}, but {flag} {asked} is taken"
        return asked, "option", (clash,) if said not in (None, asked) else ()
    if said is not None:
        return said, "file", ()
    guess = f"the file does not say its {what}: {default} is taken; {flag} says otherwise"
    return default, "default", (guess,)


def _meridional(curve: Array, axis: int) -> Array:
    """Return axial position and radius, (n, 2), of points that may be given in space."""
    if curve.shape[1] == 2:
        return curve
    return np.column_stack([curve[:, axis], np.linalg.norm(np.delete(curve, axis, 1), axis=1)])
