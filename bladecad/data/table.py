"""Tables with a header line: columns by name, cells by row."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import final

import numpy as np

from bladecad.arrays import Array
from bladecad.data.sections import Axis, Unit
from bladecad.data.text import Text, fields, is_row, number
from bladecad.errors import DataError

UNITS: dict[str, Unit] = {
    "mm": "mm", "cm": "cm", "m": "m", "in": "in", "inch": "in", "inches": "in", "ft": "ft",
    "millimeter": "mm", "millimeters": "mm", "centimeter": "cm", "centimeters": "cm",
    "meter": "m", "meters": "m", "feet": "ft", "foot": "ft", "millimetres": "mm", "metres": "m",
}  # fmt: skip
AXES: dict[str, Axis] = {"x": "x", "y": "y", "z": "z"}


@final
@dataclass(frozen=True)
class Table:
    """A table under its header.

    columns : names without unit, in lower case
    units   : the unit each column carries in its name, None if it carries none
    rows    : cells, one tuple a line, with the line's index
    groups  : number, from 1, of the blank-line separated group of each row
    """

    text: Text
    header: int
    columns: tuple[str, ...]
    units: tuple[Unit | None, ...]
    rows: tuple[tuple[int, tuple[str, ...]], ...]
    groups: tuple[str, ...]

    def values(self, *names: str) -> Array:
        """Return columns as numbers, (rows, names); a missing column or cell is named."""
        places = [self.place(name) for name in names]
        found = [[self._cell(i, cells, k) for k in places] for i, cells in self.rows]
        return np.array(found, dtype=np.float64).reshape(-1, len(names))

    def labels(self, name: str) -> list[str]:
        """Return a column as text."""
        k = self.place(name)
        return [cells[k].strip() if k < len(cells) else "" for _, cells in self.rows]

    def place(self, name: str) -> int:
        """Return the position of a column.

        Raises
        ------
        DataError
            If the header does not have it.
        """
        if name not in self.columns:
            raise DataError(
                f'{self.text.at(self.header)}: no column "{name}", there are '
                f"{', '.join(self.columns)}; add it to the header and to every row"
            )
        return self.columns.index(name)

    def unit(self, *names: str) -> Unit | None:
        """Return the one unit of these columns, None if they carry none."""
        found = {self.units[self.place(name)] for name in names}
        if len(found) > 1:
            raise DataError(
                f"{self.text.at(self.header)}: columns {', '.join(names)} differ in unit; use one"
            )
        return found.pop()

    def _cell(self, index: int, cells: tuple[str, ...], k: int) -> float:
        if k >= len(cells) or not cells[k].strip():
            raise DataError(
                f'{self.text.at(index)}: column "{self.columns[k]}" is empty; complete the row'
            )
        return number(cells[k], self.text.at(index))


def header_of(text: Text) -> tuple[int, tuple[str, ...]]:
    """Return the line and words of the header: the first line that is no comment and no numbers."""
    for i, line in enumerate(text.lines):
        if line.strip() and not line.lstrip().startswith(("#", "!")):
            words = () if is_row(line) else tuple(word.lower() for word in _split(line, line))
            return i, words
    return 0, ()


def read_table(text: Text) -> Table:
    """Read the rows under the header."""
    start, words = header_of(text)
    named = [_name_and_unit(word) for word in words]
    rows: list[tuple[int, tuple[str, ...]]] = []
    groups: list[str] = []
    blank = True
    for i, line in enumerate(text.lines[start + 1 :], start + 1):
        if not line.strip():
            blank = True
        elif not line.lstrip().startswith(("#", "!")):
            rows.append((i, tuple(_split(line, text.lines[start]))))
            groups.append(str(len(set(groups)) + 1) if blank else groups[-1])
            blank = False
    columns, units = tuple(n for n, _ in named), tuple(u for _, u in named)
    return Table(text, start, columns, units, tuple(rows), tuple(groups))


def _split(line: str, header: str) -> list[str]:
    sign = next((sign for sign in ",;\t" if sign in header.strip()), None)
    return [cell.strip(" \t\"'") for cell in line.split(sign)] if sign else fields(line)


def _name_and_unit(word: str) -> tuple[str, Unit | None]:
    match = re.fullmatch(r"(.+?)[_ \[(]+(mm|cm|m|in|inch|ft)[\])]?", word)
    return (match[1], UNITS[match[2]]) if match else (word, None)
