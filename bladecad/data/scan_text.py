"""Clouds of points as text: any separator, headers, comments, decimal commas, more columns."""

from __future__ import annotations

import math
import re
import warnings
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final, final

import numpy as np

from bladecad.arrays import Array, Points
from bladecad.data.scan_layout import Layout, is_comment, is_number, layout_of, opened
from bladecad.data.text import fields
from bladecad.errors import DataError

CHUNK: Final = 1 << 24  # bytes read at a time: memory stays with the points themselves
SLOW: Final = 1 << 14  # bytes, read word by word where something else than numbers stands in them
MISSING = re.compile(r"|-|na|n/a|null|none|[-+]?(nan|inf|infinity|1\.#\w+)")


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


def chunks(path: Path, skip: int) -> Iterator[bytes]:
    """The file without its first lines, in pieces that end with a line."""
    rest = b""
    with opened(path) as file:
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
    kept = [k for k, text in enumerate(texts) if text.strip() and not is_comment(text)]
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
    numeric = sum(is_number(word) for word in words)
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
