"""Sections into any of the files they are read from, by suffix."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike
from pathlib import Path

from bladecad.data.csv import write_csv
from bladecad.data.geomturbo_writer import write_geomturbo
from bladecad.data.ibl import write_ibl
from bladecad.data.points import write_points
from bladecad.data.sections import Sections
from bladecad.data.turbogrid import write_turbogrid
from bladecad.errors import ExportError

WRITERS: dict[str, Callable[[Sections, Path], None]] = {
    ".csv": write_csv,
    ".curve": write_turbogrid,
    ".crv": write_turbogrid,
    ".geomturbo": write_geomturbo,
    ".ibl": write_ibl,
    ".txt": write_points,
    ".dat": write_points,
    ".xyz": write_points,
    ".pts": write_points,
}


def write_sections(sections: Sections, path: str | PathLike[str]) -> None:
    """Write sections in mm, in the format of the suffix.

    Raises
    ------
    ExportError
        If the suffix is unknown, the file cannot be written, or the format needs sides that are
        not named.
    """
    check_suffix(path)
    WRITERS[Path(path).suffix.lower()](sections, Path(path))


def check_suffix(path: str | PathLike[str]) -> None:
    """Raise ExportError unless sections can be written in the format of a suffix."""
    suffix = Path(path).suffix.lower()
    if suffix not in WRITERS:
        known = ", ".join(WRITERS)
        raise ExportError(f'{path}: sections are not written as "{suffix}"; choose one of {known}')
