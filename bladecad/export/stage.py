"""Files that appear together or not at all: written beside, then moved in one go."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Final

from bladecad.errors import ExportError

REPORT: Final = "report.json"


def check_folder(folder: str | os.PathLike[str], *, force: bool = False) -> None:
    """Raise ExportError unless files can be written to a folder that is new, empty, or given up.

    Parameters
    ----------
    folder : path
    force : bool
        Files of an earlier blade in the folder may be replaced.
    """
    folder = Path(folder)
    try:
        if folder.is_dir() and any(folder.iterdir()) and not force:
            raise ExportError(
                f"{folder} is not empty and is kept as it is; "
                "name another folder, or give --force to replace the blade in it"
            )
        stage = _stage(folder)
        stage.mkdir()
        stage.rmdir()
    except OSError as error:
        raise _unwritable(folder, error) from error


def check_file(file: str | os.PathLike[str], *, force: bool = False) -> None:
    """Raise ExportError where a file exists and may not be replaced, or its folder is missing."""
    file = Path(file)
    if not file.parent.is_dir():
        raise ExportError(f"{file} cannot be written: there is no folder {file.parent}; make it")
    if file.is_dir():
        raise ExportError(f"{file} is a folder; name a file in it")
    if os.path.lexists(file) and not force:
        raise ExportError(
            f"{file} exists and is kept as it is; name another file, or give --force to replace it"
        )


@contextmanager
def staged(
    folder: str | os.PathLike[str], *, force: bool = False, report: str = REPORT
) -> Iterator[Path]:
    """Give a folder to write into, whose files appear in `folder` once all is well.

    Whatever goes wrong inside, an interruption from the keyboard too, leaves `folder` as it was.
    Files of an earlier blade, named under "files" in its `report`, are removed where the new one
    lacks them; other files stay.

    Raises
    ------
    ExportError
        As `check_folder`, where a file cannot be written, and where the earlier report is of
        another kind: what it vouches for is not what is replaced.
    """
    folder = Path(folder)
    check_folder(folder, force=force)
    stage = _stage(folder)
    try:
        stage.mkdir()
        yield stage
        _move(stage, folder, report)
    except OSError as error:
        raise _unwritable(folder, error) from error
    finally:
        shutil.rmtree(stage, ignore_errors=True)


def _stage(folder: Path) -> Path:
    """A hidden folder on the same disk: inside the folder where it exists, else above it."""
    anchor = folder.absolute()
    while not os.path.lexists(anchor):
        anchor = anchor.parent
    return anchor / f".bladecad.{os.getpid()}.part"


def _move(stage: Path, folder: Path, report: str) -> None:
    """Move all files; into a folder that exists one by one, the report, which vouches, last."""
    if not folder.exists():
        folder.parent.mkdir(parents=True, exist_ok=True)
        stage.rename(folder)
        return
    _check_kind(folder / report, stage / report)
    for stale in _earlier(folder, report):
        stale.unlink(missing_ok=True)
    files = [file for file in stage.rglob("*") if file.is_file()]
    for file in sorted(files, key=lambda file: file.name == report):
        target = folder / file.relative_to(stage)
        target.parent.mkdir(parents=True, exist_ok=True)
        file.replace(target)


def _check_kind(earlier: Path, new: Path) -> None:
    """Refuse to replace the report of a build by that of a check, and the like."""
    before, after = _schema(earlier), _schema(new)
    if before and after and before != after:
        raise ExportError(
            f"{earlier} is a {before}, and would be replaced by a {after}; name another folder"
        )


def _schema(report: Path) -> str | None:
    """The kind of a report, without its version; None where it does not say."""
    try:
        said = json.loads(report.read_bytes())["schema"]
    except (OSError, ValueError, KeyError, TypeError):
        return None
    return said.partition("/")[0] if isinstance(said, str) else None


def _earlier(folder: Path, report: str) -> list[Path]:
    """The report of an earlier blade, and the files it names, in the folder or below it."""
    said = folder / report
    try:
        named = [Path(entry["file"]) for entry in json.loads(said.read_bytes())["files"]]
    except (OSError, ValueError, KeyError, TypeError):
        named = []
    inside = [name for name in named if not name.is_absolute() and ".." not in name.parts]
    return [said, *(folder / name for name in inside if not (folder / name).is_dir())]


def _unwritable(folder: Path, error: OSError) -> ExportError:
    return ExportError(
        f"{folder} cannot be written: {error.strerror}; name another folder or free this one"
    )
