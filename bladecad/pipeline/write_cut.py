"""Sections cut from a blade, written and read back before they are seen."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np

from bladecad.data.loops import arcs, size
from bladecad.data.read import read_sections
from bladecad.data.sections import Section, Sections
from bladecad.data.write import NOMINAL, WRITERS, check_suffix, nominal_writer, write_with
from bladecad.errors import ExportError
from bladecad.pipeline.sections_of import CutBlade
from bladecad.surface.cut import Cut
from bladecad.surface.levels import Cylinders

PRINTED: Final = 1e-9  # of the size and the place: ten digits


def write_cut(found: CutBlade, path: str | Path, *, force: bool = False) -> tuple[Path, ...]:
    """Write sections in the format of the suffix, read them back, and only then show the files.

    Raises
    ------
    ExportError
        If the suffix is unknown, a file exists and may not be replaced, or what is read back
        differs in a point or a side.
    """
    path = Path(path)
    check_suffix(path, normals=True)
    heights = [_height(cut, found) for cut in found.cuts]
    nominal = nominal_writer([cut.normals for cut in found.cuts], heights)
    suffix = path.suffix.lower()
    writer = nominal if suffix == NOMINAL else WRITERS[suffix]
    return write_with(
        writer,
        found.sections,
        path,
        force=force,
        confirm=lambda file: confirm(found.sections, read_sections(file)),
    )


def confirm(written: Sections, read: Sections) -> None:
    """Raise ExportError unless sections read back as they were, to the printed digits."""
    turn = read.axis - written.axis if read.source.axis_from == "file" else 0
    if len(read.sections) != len(written.sections):
        raise ExportError(
            f"{len(read.sections)} sections are read back of {len(written.sections)}; choose "
            "another format"
        )
    for ours, theirs in zip(written.sections, read.sections, strict=True):
        away = _apart(ours, theirs, turn)
        if away > PRINTED * (size(ours.points) + float(np.abs(ours.points).max())):
            raise ExportError(
                f'section "{ours.name}" is read back {away:.3g} mm off; choose another format'
            )


def _apart(ours: Section, theirs: Section, turn: int) -> float:
    """Largest distance between the same points; side by side where both name their edges."""
    mine, other = arcs(ours), arcs(theirs)
    pairs = [(ours.points, theirs.points)]
    if mine is not None and other is not None:
        swapped = theirs.suction is not None and theirs.suction != ours.suction
        pairs = list(zip(mine, other[::-1] if swapped else other, strict=True))
    if any(len(a) != len(b) for a, b in pairs):
        return np.inf
    return max(float(np.abs(np.roll(a, turn, axis=1) - b).max()) for a, b in pairs)


def _height(cut: Cut, found: CutBlade) -> float:
    """Height of a plane or radius of a cylinder, mm; mean radius of a stream surface."""
    if found.on != "streams":
        return cut.place
    return float(Cylinders(found.sections.axis).height(cut.points).mean())
