"""A file that is whole or not there."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from bladecad.errors import ExportError


@contextmanager
def beside(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a path to write to, renamed to `path` once all is well, and removed otherwise.

    Raises
    ------
    ExportError
        If the file cannot be written.
    """
    path = Path(path)
    part = path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")
    try:
        yield part
        part.replace(path)
    except OSError as error:
        raise ExportError(f"{path} cannot be written: {error.strerror}; choose another") from error
    finally:
        with suppress(OSError):
            part.unlink()
