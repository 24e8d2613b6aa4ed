"""Text as it is met in the wild, and its numbers; every error names file, line and text."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import final

import numpy as np

from bladecad.arrays import Array
from bladecad.errors import DataError
from bladecad.written import beside

_NUMBER = r"(?:\d+\.?\d*|\.\d+)(?:[eEdD][+-]?\d+)?"
_RUN_TOGETHER = re.compile(rf"[+-]?{_NUMBER}(?:[+-]{_NUMBER})*")
_PARTS = re.compile(rf"[+-]?{_NUMBER}")
_DECIMAL_COMMA = re.compile(r"[+-]?\d+,\d+")
_NOT_FINITE = re.compile(r"[+-]?(nan|inf|infinity|1\.#\w+|\*+)", re.IGNORECASE)


@final
@dataclass(frozen=True)
class Text:
    """A file as its lines, without line ends or byte order mark."""

    path: Path
    lines: tuple[str, ...]

    def at(self, index: int) -> str:
        """Name a line as the user sees it: `blade.csv, line 12`."""
        return f"{self.path.name}, line {index + 1}"


def read_text(path: Path) -> Text:
    """Read a text file in UTF-8, UTF-16 or Latin-1; decimal commas become points.

    Raises
    ------
    DataError
        If the file does not exist, is empty, or is binary.
    """
    try:
        raw = path.read_bytes()
    except OSError as error:
        raise DataError(f"{path} cannot be read: {error.strerror}; check the path") from error
    if not raw.strip():
        raise DataError(f"{path.name} is empty; export the sections again")
    return Text(path, tuple(_decimal_points(_decode(path, raw).splitlines())))


def write_text(path: Path, text: str) -> None:
    """Write beside and rename, so that no half-written file is ever left behind.

    Raises
    ------
    ExportError
        If the folder is missing or cannot be written to.
    """
    with beside(path) as file:
        file.write_text(text, encoding="utf-8", newline="\n")


def fields(line: str) -> list[str]:
    """Split a line at blanks, tabs, commas and semicolons."""
    return re.split(r"\s*[,;]\s*|\s+", line.strip(" \t,;"))


def is_row(line: str) -> bool:
    """Whether a line is meant as a row of numbers, though one of them may be misspelt."""
    found = fields(line)
    numeric = sum(_is_number(text) for text in found)
    return numeric >= 2 and 2 * numeric > len(found)


def numbers(text: Text, index: int, *, skip: int = 0, count: int | None = None) -> list[float]:
    """Return the numbers of a line, Fortran's run-together and D-exponent ones too.

    Parameters
    ----------
    skip, count : int
        Pass over the first `skip` fields; take `count` numbers, which must be there.

    Raises
    ------
    DataError
        If a field is no number, is NaN or infinite, or fewer than `count` are found.
    """
    values: list[float] = []
    for field in fields(text.lines[index])[skip:]:
        if count is not None and len(values) >= count:
            break
        values += _values(field, text.at(index))
    if count is not None and len(values) < count:
        raise DataError(f"{text.at(index)}: {len(values)} numbers, {count} are needed; complete it")
    return values


def number(field: str, at: str) -> float:
    """Return one field as a number; `at` is the place an error names."""
    values = _values(field.strip(), at)
    if len(values) > 1:
        raise DataError(f'{at}: "{field}" is no number; correct it or remove the line')
    return values[0]


def table(text: Text, rows: tuple[int, ...], *, skip: int = 0, count: int = 3) -> Array:
    """Return the numbers of several lines as an array, (rows, count)."""
    found = [numbers(text, i, skip=skip, count=count) for i in rows]
    return np.array(found).reshape(-1, count)


def _values(field: str, at: str) -> list[float]:
    parts = _PARTS.findall(field) if _RUN_TOGETHER.fullmatch(field) else []
    if not parts and _NOT_FINITE.fullmatch(field):
        raise DataError(f'{at}: "{field}" is not finite; measure this point again or remove it')
    if not parts or (len(parts) > 1 and not all("." in part for part in parts)):
        raise DataError(f'{at}: "{field}" is no number; correct it or remove the line')
    values = [float(part.upper().replace("D", "E")) for part in parts]
    if not all(map(math.isfinite, values)):
        raise DataError(f'{at}: "{field}" is not finite; measure this point again or remove it')
    return values


def _is_number(field: str) -> bool:
    return bool(_RUN_TOGETHER.fullmatch(field) or _NOT_FINITE.fullmatch(field))


def has_decimal_commas(lines: Sequence[str]) -> bool:
    """Whether numbers are written `1,5`: none has a point, and commas stand within them."""
    return not any(re.search(r"\d\.\d", line) for line in lines) and any(
        map(_has_decimal_commas, lines)
    )


def _decode(path: Path, raw: bytes) -> str:
    if raw.startswith((b"\xff\xfe", b"\xfe\xff")):
        return raw.decode("utf-16", errors="replace")
    control = [i for i, byte in enumerate(raw[:4096]) if byte < 32 and byte not in b"\t\n\r\f\x1a"]
    if control:
        raise DataError(
            f"{path.name} is not text (byte {raw[control[0]]:#04x} at offset {control[0]}); "
            "sections are read from text: export them as CSV, .curve or .geomTurbo"
        )
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError:
        return raw.decode("latin-1")


def _decimal_points(lines: list[str]) -> list[str]:
    """Turn `1,5; 2` into `1.5; 2`, where the whole file writes its numbers so."""
    return [line.replace(",", ".") for line in lines] if has_decimal_commas(lines) else lines


def _has_decimal_commas(line: str) -> bool:
    """Whether a comma stands within numbers that something else separates."""
    found = re.split(r"\s*;\s*" if ";" in line else r"\s+", line.strip(" \t;"))
    commas = [field for field in found if "," in field]
    return len(found) > 1 and bool(commas) and all(map(_DECIMAL_COMMA.fullmatch, commas))
