"""Plain points: one section a file, or sections between blank lines or under headings.

Also formatted point data, whose first line gives points a section and sections: `240 21`.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from bladecad.arrays import Array
from bladecad.data import beside
from bladecad.data.blocks import Block, blocks
from bladecad.data.draft import Draft
from bladecad.data.loops import loop
from bladecad.data.sections import Sections
from bladecad.data.text import Text, fields, numbers, table, write_text
from bladecad.errors import DataError


def recognises(text: Text) -> bool:
    """Whether most lines that say something are rows of numbers, three or four wide."""
    said = [line for line in text.lines if line.strip() and line.lstrip()[0] not in "#!%*"]
    wide = [row for block in blocks(text) for row in block.rows if len(fields(text.lines[row])) > 2]
    return 2 * len(wide) > len(said)


def read(text: Text) -> Draft:
    """Read the blocks as sections; `Info.txt`, hub and shroud beside them are read too."""
    found = blocks(text)
    counted = _counted(text, found)
    sections = tuple(
        loop(block.name(_name(text, found, k)), _rows(text, block))
        for k, block in enumerate(counted or found)
    )
    draft = Draft("formatted point data" if counted else "points", sections)
    if text.path.name.startswith("blade3d."):  # as T-Blade3 names and writes it
        draft = replace(draft, unit="mm", axis="x")
    return beside.told(draft, text.path)


def write_points(sections: Sections, path: Path) -> None:
    """Write sections in mm under `#` headings, a closed loop with its first point repeated."""
    lines: list[str] = []
    for section in sections.sections:
        loop = np.vstack([section.points, section.points[: int(section.closed)]])
        lines += [f"# {section.name}", *(f"{x:.10g} {y:.10g} {z:.10g}" for x, y, z in loop), ""]
    write_text(path, "\n".join(lines))


def _counted(text: Text, found: tuple[Block, ...]) -> tuple[Block, ...]:
    """Return the sections of a file whose first row is `npts nsec`; () if it is not."""
    rows = [row for block in found for row in block.rows]
    first = fields(text.lines[rows[0]])
    if len(first) != 2 or not all(field.strip("+").isdigit() for field in first):
        return ()
    n, m = (int(field) for field in first)
    if n * m != len(rows) - 1:
        raise DataError(
            f"{text.at(rows[0])}: {n} points in {m} sections announced, {len(rows) - 1} rows "
            "follow; correct the counts or complete the file"
        )
    return tuple(Block((), tuple(rows[1 + k * n : 1 + (k + 1) * n])) for k in range(m))


def _rows(text: Text, block: Block) -> Array:
    """Return x, y, z; a fourth column before them is an index."""
    width = len(numbers(text, block.rows[0]))
    return table(text, block.rows, skip=1 if width == 4 else 0)


def _name(text: Text, found: tuple[Block, ...], k: int) -> str:
    return text.path.stem if len(found) == 1 else f"{k + 1}"
