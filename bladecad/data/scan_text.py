"""Clouds of points as text: any separator, headers, comments, decimal commas, more columns."""

from __future__ import annotations

import math
import re
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from io import BytesIO
from itertools import pairwise
from pathlib import Path
from typing import BinaryIO, Final, final

import numpy as np

from bladecad.arrays import Array, Points
from bladecad.data.scan_unit import unit_said
from bladecad.data.sections import Unit
from bladecad.data.table import UNITS
from bladecad.data.text import fields, has_decimal_commas
from bladecad.errors import DataError

CHUNK: Final = 1 << 24  # bytes read at a time: memory stays with the points themselves
SLOW: Final = 1 << 14  # bytes, read word by word where something else than numbers stands in them
HEAD: Final = 200  # lines looked at to learn how a file is written
COMMENT: Final = ("#", "//", "!", "%", "*", ";;")
MISSING = re.compile(r"|-|na|n/a|null|none|[-+]?(nan|inf|infinity|1\.#\w+)")
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


@final
@dataclass(frozen=True, eq=False)
class Cloud:
    """The points of a text, NaN where a number is missing, in the unit of the file."""

    points: Points
    layout: Layout
    notes: tuple[str, ...]


def read_cloud(path: Path, layout: Layout | None = None) -> Cloud:
    """Read x, y, z of every row of numbers; other lines are passed over.

    Parameters
    ----------
    path : path
    layout : Layout, optional
        Where a head says it; otherwise learnt from the first lines.

    Raises
    ------
    DataError
        If no row has three numbers, a row is misspelt or cut off, or points are missing.
    """
    layout = layout or layout_of(path)
    parts: list[Array] = []
    passed, line = 0, layout.header
    for chunk in chunks(path, layout.header):
        found, other = _parsed(chunk, layout, f"{path.name}, line", line)
        parts += found
        passed, line = passed + other, line + chunk.count(b"\n")
    points = np.concatenate(parts)
    if layout.count not in (None, len(points)):
        raise DataError(
            f"{path.name}: {layout.count} points announced, {len(points)} follow; the file is cut "
            "off or was edited: export it again, or remove the count"
        )
    return Cloud(points, layout, tuple(_notes(layout, passed)))


def _notes(layout: Layout, passed: int) -> Iterator[str]:
    if layout.width > 3:
        named = ", ".join(str(k + 1) for k in layout.columns)
        yield f"{layout.width} numbers a row: columns {named} are taken as x, y, z"
    if layout.commas:
        yield "decimal commas are read as points"
    if passed:
        yield f"{passed} lines without numbers passed over"


def layout_of(path: Path) -> Layout:
    """Learn from the first lines how the file is written."""
    with _opened(path) as file:
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
    rows = [k for k, row in enumerate(words) if _is_row(row) and not _comment(lines[k])]
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
        if not _comment(lines[k]):
            columns, unit = _named(fields(BRACKET.sub(r"\1", lines[k - 1])), len(row))
            if columns and all(_is_number(row[c]) for c in columns):
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


def _opened(path: Path) -> BinaryIO:
    """The file as lines of ASCII; UTF-16 and lone carriage returns are rare, and turned at once."""
    with path.open("rb") as file:
        head = file.read(1 << 16)
    if head.startswith((b"\xff\xfe", b"\xfe\xff")):
        text = path.read_bytes().decode("utf-16", errors="replace")
        return BytesIO(text.replace("\r\n", "\n").encode())
    if b"\r" in head and b"\n" not in head:
        return BytesIO(path.read_bytes().replace(b"\r", b"\n"))
    return path.open("rb")


def chunks(path: Path, skip: int) -> Iterator[bytes]:
    """The file without its first lines, in pieces that end with a line."""
    rest = b""
    with _opened(path) as file:
        for _ in range(skip):
            file.readline()
        while block := file.read(CHUNK):
            block = rest + block.replace(b"\r", b"")
            cut = block.rfind(b"\n") + 1
            rest = block[cut:]
            if cut:
                yield block[:cut]
    if rest:
        yield rest + b"\n"


def _parsed(chunk: bytes, layout: Layout, at: str, line: int) -> tuple[list[Array], int]:
    """Points of a chunk, and how many of its lines hold none.

    Whatever is no plain row of numbers is hunted down by halves, and read word by word.
    """
    lines = chunk.count(b"\n")
    table = bytes.maketrans(b',;\t"', b".   " if layout.commas else b"    ")
    values = numbers(chunk.translate(table))
    if values is not None and len(values) == lines * layout.width:
        return [values.reshape(lines, layout.width)[:, layout.columns]], 0
    if len(chunk) < SLOW:
        return _by_word(chunk, layout, at, line)
    half = chunk.index(b"\n", len(chunk) // 2) + 1
    first, passed = _parsed(chunk[:half], layout, at, line)
    second, other = _parsed(chunk[half:], layout, at, line + chunk.count(b"\n", 0, half))
    return first + second, passed + other


def _by_word(chunk: bytes, layout: Layout, at: str, line: int) -> tuple[list[Array], int]:
    texts = chunk.decode("utf-8", errors="replace").replace('"', "").splitlines()
    kept = [k for k, text in enumerate(texts) if text.strip() and not _comment(text)]
    found = [_row(texts[k], layout, f"{at} {line + k + 1}") for k in kept]
    points = np.array([row for row in found if row is not None]).reshape(-1, 3)
    return [points], sum(row is None for row in found)


def numbers(chunk: bytes) -> Array | None:
    """All numbers of a chunk, None where anything else stands in it."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            return np.fromstring(chunk, dtype=np.float64, sep=" ")
        except (DeprecationWarning, ValueError):
            return None


def _row(text: str, layout: Layout, at: str) -> tuple[float, ...] | None:
    """x, y, z of one line, None where it holds no row."""
    words = fields(text.replace(",", ".") if layout.commas else text)
    numeric = sum(_is_number(word) for word in words)
    if 2 * numeric <= len(words):
        return None
    if len(words) <= max(layout.columns):
        raise DataError(
            f"{at}: {len(words)} numbers, {layout.width} are usual; "
            "the file is cut off or the row was edited: export it again"
        )
    return tuple(_value(words[k], at) for k in layout.columns)


def _value(word: str, at: str) -> float:
    if MISSING.fullmatch(word.lower()):
        return math.nan
    try:
        return float(word)
    except ValueError as error:
        raise DataError(f'{at}: "{word}" is no number; correct it or remove the line') from error


def _is_row(words: Sequence[str]) -> bool:
    return len(words) >= 3 and all(map(_is_number, words[:3]))


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _comment(line: str) -> bool:
    return line.lstrip().startswith(COMMENT)
