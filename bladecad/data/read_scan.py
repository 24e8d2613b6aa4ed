"""A scan from any file: meshes, clouds of points, sections too, in mm."""

from __future__ import annotations

from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Final

import numpy as np

from bladecad.arrays import Points
from bladecad.data.draft import choose
from bladecad.data.formats import recognise
from bladecad.data.read import read_sections
from bladecad.data.scan import Scan
from bladecad.data.scan_clean import Triangles, cleaned
from bladecad.data.scan_mesh import cloud_layout, mesh_format, mesh_unit, read_mesh
from bladecad.data.scan_text import read_cloud
from bladecad.data.scan_unit import unit_by_size, unit_note
from bladecad.data.sections import MM_PER, Source, Unit
from bladecad.data.table import header_of
from bladecad.data.text import Text
from bladecad.errors import DataError

FEWEST: Final = 3  # points; whether they are a blade is for others to say
HEAD: Final = 1 << 16  # bytes in which sections are recognised
CLOUD_SUFFIXES: Final = (".xyz", ".asc", ".pts", ".csv", ".txt", ".dat")


def read_scan(path: str | PathLike[str], *, unit: Unit | None = None) -> Scan:
    """Read a scan: STL, PLY, OBJ, OFF; points as XYZ, ASC, PTS, CSV, TXT; or sections.

    The content decides, not the suffix. Points keep the order of the file; those that are not
    finite, repeated or, in a mesh, without a triangle are dropped, and `source.notes` counts them.

    Parameters
    ----------
    path : path
    unit : {"mm", "cm", "m", "in", "ft"}
        Wins over what the file says; where neither says, mm, or m for what would be below 2 mm.

    Raises
    ------
    DataError
        If the file cannot be read, is cut off, or holds no points.
    """
    path = Path(path)
    if path.is_dir() or holds_sections(_checked(path)):
        return _of_sections(path, unit)
    form = mesh_format(path)
    layout = cloud_layout(path) if form == "PLY" else None
    if form and not layout:
        points, triangles, dropped = cleaned(*read_mesh(path, form), soup=form == "STL")
        said = mesh_unit(path, form)
        return _settled(points, triangles, Source(path, form, notes=dropped), said, unit)
    cloud = read_cloud(path, layout)
    points, _, dropped = cleaned(cloud.points)
    source = Source(path, form or "points", notes=(*cloud.notes, *dropped))
    return _settled(points, None, source, cloud.layout.unit, unit)


def _settled(
    points: Points,
    triangles: Triangles | None,
    source: Source,
    said: Unit | None,
    unit: Unit | None,
) -> Scan:
    """Turn points into mm, and say where the unit came from."""
    assert source.path is not None
    if len(points) < FEWEST:
        raise DataError(
            f"{source.path.name} holds {len(points)} points that can be used; export the scan again"
        )
    usual, size = unit_by_size(points)
    in_unit, unit_from, notes = choose("unit", "--units", said, unit, usual)
    notes = (unit_note(usual, size),) if unit_from == "default" else notes
    points = points * MM_PER[in_unit] if in_unit != "mm" else points
    return Scan(
        points, triangles,
        replace(source, unit=in_unit, unit_from=unit_from, notes=(*notes, *source.notes)),
    )  # fmt: skip


def _of_sections(path: Path, unit: Unit | None) -> Scan:
    sections = read_sections(path, unit=unit)
    points = np.concatenate([section.points for section in sections.sections])
    points, _, dropped = cleaned(points)
    source = sections.source
    counted = f"the points of {len(sections.sections)} sections are the scan"
    notes = tuple(note for note in source.notes if "--axis" not in note)
    return Scan(points, None, replace(source, path=path, notes=(*notes, counted, *dropped)))


def _checked(path: Path) -> Path:
    try:
        with path.open("rb") as file:
            head = file.read(64)
    except OSError as error:
        raise DataError(f"{path} cannot be read: {error.strerror}; check the path") from error
    if not head.strip():
        raise DataError(f"{path.name} is empty; export the scan again")
    return path


def holds_sections(path: Path) -> bool:
    """Whether a file is told to be sections by more than its rows of numbers."""
    with path.open("rb") as file:
        head = file.read(HEAD)
    if b"\0" in head:
        return False
    text = Text(path, tuple(head.decode("utf-8-sig", errors="replace").splitlines()))
    try:
        form = recognise(text)
    except (DataError, IndexError):
        return False
    if form.name == "table of points":
        return bool({"section", "side"} & set(header_of(text)[1]))
    if form.name == "TurboGrid":
        return path.suffix.lower() not in CLOUD_SUFFIXES
    return form.name != "points"
