"""Sections into any of the files they are read from, by suffix: all files of a blade, or none."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Sequence
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from bladecad.arrays import Points
from bladecad.data.csv import write_csv
from bladecad.data.family import siblings
from bladecad.data.geomturbo_writer import write_geomturbo
from bladecad.data.ibl import write_ibl
from bladecad.data.nominal_points import write_nominal
from bladecad.data.points import write_points
from bladecad.data.sections import Sections
from bladecad.data.sldcrv import write_sldcrv
from bladecad.data.turbogrid import write_turbogrid
from bladecad.errors import ExportError

if TYPE_CHECKING:
    from collections.abc import Iterator

Writer: TypeAlias = Callable[[Sections, Path], None]

WRITERS: dict[str, Writer] = {
    ".csv": write_csv,
    ".curve": write_turbogrid,
    ".crv": write_turbogrid,
    ".geomturbo": write_geomturbo,
    ".ibl": write_ibl,
    ".sldcrv": write_sldcrv,
    ".txt": write_points,
    ".dat": write_points,
    ".xyz": write_points,
    ".pts": write_points,
}
NOMINAL = ".nom"  # needs normals beside the points


def write_sections(
    sections: Sections, path: str | PathLike[str], *, force: bool = True
) -> tuple[Path, ...]:
    """Write sections in mm, in the format of the suffix; all files appear together.

    Parameters
    ----------
    sections : Sections
    path : path
        A format may write more files beside it, named after it: hub, shroud and `.inf` of
        TurboGrid, a file for each section of SolidWorks.
    force : bool
        Files that exist are replaced; else they are kept and nothing is written.

    Returns
    -------
    paths
        Of all files written.

    Raises
    ------
    ExportError
        If the suffix is unknown, the file cannot be written, or the format needs sides that are
        not named.
    """
    check_suffix(path)
    return write_with(WRITERS[Path(path).suffix.lower()], sections, path, force=force)


def write_with(
    writer: Writer,
    sections: Sections,
    path: str | PathLike[str],
    *,
    force: bool = True,
    confirm: Callable[[Path], None] = lambda _: None,
) -> tuple[Path, ...]:
    """Write sections by a writer; what it wrote may be confirmed before any file is seen.

    Parameters
    ----------
    confirm : callable
        Given the first file written, in the hidden folder where it still stands; raises where it
        is not what it should be.
    """
    path = Path(path)
    with _staged(path) as stage:
        writer(sections, stage / path.name)
        files = sorted(stage.iterdir(), key=lambda file: (file.name != path.name, file.name))
        _keep_what_exists(path, files, force)
        confirm(files[0])
        for file in files:
            os.replace(file, path.with_name(file.name))
    return tuple(path.with_name(file.name) for file in files)


def nominal_writer(normals: Sequence[Points], heights: Sequence[float]) -> Writer:
    """A writer of `.nom` files, which hold the normals and heights of the sections too."""
    return lambda sections, path: write_nominal(sections, path, normals, heights)


def check_suffix(path: str | PathLike[str], *, normals: bool = False) -> None:
    """Raise ExportError unless sections can be written in the format of a suffix.

    Parameters
    ----------
    normals : bool
        Whether normals are known, which `.nom` needs.
    """
    suffix = Path(path).suffix.lower()
    if suffix == NOMINAL and not normals:
        raise ExportError(
            f"{path}: a nominal holds normals, which sections alone do not have; cut it from a "
            "surface, with bladecad convert"
        )
    if suffix not in WRITERS and suffix != NOMINAL:
        known = ", ".join([*WRITERS, NOMINAL])
        raise ExportError(f'{path}: sections are not written as "{suffix}"; choose one of {known}')


@contextmanager
def _staged(path: Path) -> Iterator[Path]:
    """Give a hidden folder beside a file, which is gone at the end."""
    stage = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        stage.mkdir()
        yield stage
    except OSError as error:
        raise ExportError(f"{path} cannot be written: {error.strerror}; choose another") from error
    finally:
        shutil.rmtree(stage, ignore_errors=True)


def _keep_what_exists(path: Path, files: Sequence[Path], force: bool) -> None:
    """Refuse to replace files unless asked to; or to join a family of more files than these."""
    names = {file.name for file in files}
    there = sorted(name for name in names if os.path.lexists(path.with_name(name)))
    if there and not force:
        raise ExportError(
            f"{path.with_name(there[0])} exists and is kept as it is; name another file, or give "
            "--force to replace it"
        )
    walls = f"{path.stem}_hub_shroud.csv"
    if path.suffix.lower() == ".csv" and walls not in names and path.with_name(walls).exists():
        raise ExportError(
            f"{path.with_name(walls)} would be read with {path.name}, which has no walls; remove "
            "it or name another file"
        )
    folders = [name for name in there if path.with_name(name).is_dir()]
    if folders:
        raise ExportError(f"{path.with_name(folders[0])} is a folder; name a file in it")
    if path.name not in names:
        others = [f.name for f in siblings(path.with_name(files[0].name)) if f.name not in names]
        if others:
            raise ExportError(
                f"{path.with_name(others[0])} would be read with the {len(names)} sections to be "
                "written; remove it or name another file"
            )
