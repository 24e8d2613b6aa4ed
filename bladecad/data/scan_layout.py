"""How a cloud in text is written, learnt from its first lines."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from io import BytesIO
from itertools import pairwise
from pathlib import Path
from typing import BinaryIO, Final, final

from bladecad.data.scan_unit import unit_said
from bladecad.data.sections import Unit
from bladecad.data.table import UNITS
from bladecad.data.text import fields, has_decimal_commas
from bladecad.errors import DataError

HEAD: Final = 200  # lines looked at to learn how a file is written
COMMENT: Final = ("#", "//", "!", "%", "*", ";;")
BRACKET = re.compile(r"\s+([\[(])")  # X [mm]
NAMED = re.compile(r"(?:points?[_:]?|coords?[_:]?)?([xyz012])(?:[_ \[(]+(\w+)[\])]?)?")


@final
@dataclass(frozen=True)
class Layout:
    """How a cloud is written.

    header  : lines before the first row
    columns : positions of x, y and z in a row
    width   : numbers in a row
    unit    : where the names of the columns say it, or a line before them
    commas  : whether numbers have decimal commas
    count   : points announced before the first, as in .pts
    """

    header: int
    columns: tuple[int, int, int]
    width: int
    unit: Unit | None
    commas: bool
    count: int | None


def layout_of(path: Path) -> Layout:
    """Learn from the first lines how the file is written."""
    with opened(path) as file:
        head = file.read(1 << 16)
    if b"\0" in head:
        raise DataError(
            f"{path.name} is neither text nor a mesh; export the scan as STL, PLY or XYZ"
        )
    lines = head.decode("utf-8-sig", errors="replace").replace('"', "").splitlines()[:HEAD]
    begun = [line for line in lines if re.match(r"\s*[-+.\d]", line)]
    commas = has_decimal_commas(begun or lines)
    words = [fields(line.replace(",", ".") if commas else line) for line in lines]
    named = _first_named(lines, words)
    rows = [k for k, row in enumerate(words) if _is_row(row) and not is_comment(lines[k])]
    if not rows and not named:
        raise DataError(
            f"{path.name}: no line with three numbers among the first {len(lines)}; a cloud has x, "
            "y, z in every line: export the scan as XYZ, PLY or STL"
        )
    first, columns, unit = named or (rows[0], _unnamed([words[k] for k in rows[:50]]), None)
    counts = [row for row in words[:first] if len(row) == 1 and row[0].isdigit()]
    return Layout(
        first, columns, len(words[first]), unit or unit_said(lines[:first]), commas,
        int(counts[-1][0]) if counts else None,
    )  # fmt: skip


def _first_named(
    lines: Sequence[str], words: Sequence[Sequence[str]]
) -> tuple[int, tuple[int, int, int], Unit | None] | None:
    """The first row below a header that names x, y and z, their columns, and their unit."""
    for k, row in enumerate(words[1:], 1):
        if not is_comment(lines[k]):
            columns, unit = _named(fields(BRACKET.sub(r"\1", lines[k - 1])), len(row))
            if columns and all(is_number(row[c]) for c in columns):
                return k, columns, unit
    return None


def _named(header: Sequence[str], width: int) -> tuple[tuple[int, int, int] | None, Unit | None]:
    """Columns that a header calls x, y and z, and their unit."""
    header = [word for word in header if word not in COMMENT]
    found: dict[str, int] = {}
    units: set[str | None] = set()
    for k, word in enumerate(header):
        match = NAMED.fullmatch(word.strip("#/'").lower())
        if match:
            name = "xyz"["012".index(match[1])] if match[1] in "012" else match[1]
            found.setdefault(name, k)
            units.add(match[2])
    if found.keys() != set("xyz") or len(header) != width:
        return None, None
    unit = units.pop() if len(units) == 1 else None
    return (found["x"], found["y"], found["z"]), UNITS.get(unit or "")


def _unnamed(rows: Sequence[Sequence[str]]) -> tuple[int, int, int]:
    """The first three columns; of four, the last three where the first one counts."""
    if len(rows[0]) == 4 and len(rows) > 2 and all(row[0].isdigit() for row in rows):
        numbers = [int(row[0]) for row in rows]
        if all(b - a == 1 for a, b in pairwise(numbers)):
            return 1, 2, 3
    return 0, 1, 2


def opened(path: Path) -> BinaryIO:
    """The file as lines of ASCII; UTF-16 and lone carriage returns are rare, and turned at once."""
    with path.open("rb") as file:
        head = file.read(1 << 16)
    if head.startswith((b"\xff\xfe", b"\xfe\xff")):
        text = path.read_bytes().decode("utf-16", errors="replace")
        return BytesIO(text.replace("\r\n", "\n").encode())
    if b"\r" in head and b"\n" not in head:
        return BytesIO(path.read_bytes().replace(b"\r", b"\n"))
    return path.open("rb")


def _is_row(words: Sequence[str]) -> bool:
    return len(words) >= 3 and all(map(is_number, words[:3]))


def is_number(word: str) -> bool:
    """Whether a word is a number, finite or not."""
    try:
        float(word)
    except ValueError:
        return False
    return True


def is_comment(line: str) -> bool:
    """Whether a line begins as comments do."""
    return line.lstrip().startswith(COMMENT)
