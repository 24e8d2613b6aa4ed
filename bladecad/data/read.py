"""Sections from any file, folder or list of files, in mm."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from typing import TypeAlias

from bladecad.data.checks import checked
from bladecad.data.draft import settle
from bladecad.data.family import blade_in, draft_of_blade, draft_of_list, member
from bladecad.data.sections import Axis, Sections, Unit
from bladecad.errors import DataError

AnyPath: TypeAlias = str | PathLike[str]


def read_sections(
    path: AnyPath | Sequence[AnyPath], *, unit: Unit | None = None, axis: Axis | None = None
) -> Sections:
    """Read a blade as its sections.

    The reader is picked by content; the suffix is only compared with it. One file of a numbered
    family, `section_01` to `section_11`, stands for the whole; so do their common name, `section`
    with the suffix, a folder and a list of files.

    Parameters
    ----------
    path : path, or several
    unit : {"mm", "cm", "m", "in", "ft"}
        Wins over what the file says; where neither says, mm.
    axis : {"x", "y", "z"}
        The machine axis, likewise; where neither says, z.

    Returns
    -------
    Sections
        In mm, in the order and the frame of the file; `source.notes` tells what was guessed.

    Raises
    ------
    DataError
        If the file cannot be read as sections, or they cannot be a blade.
    """
    if not isinstance(path, str | PathLike):
        paths = [Path(one) for one in path]
        if not paths:
            raise DataError("no file to read; name one")
        return checked(settle(draft_of_list(paths), paths[0], unit, axis))
    file = blade_in(Path(path)) if Path(path).is_dir() else member(Path(path))
    return checked(settle(draft_of_blade(file), file, unit, axis))
