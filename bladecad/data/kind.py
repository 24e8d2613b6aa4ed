"""Scan or sections: told by the content of a file, not by its suffix."""

from __future__ import annotations

from pathlib import Path
from typing import Final, Literal

import numpy as np

from bladecad.arrays import Array, Points
from bladecad.data.blocks import Block, blocks
from bladecad.data.family import siblings
from bladecad.data.read_scan import HEAD, holds_sections
from bladecad.data.scan_layout import Layout, layout_of
from bladecad.data.scan_mesh import mesh_format
from bladecad.data.text import Text, fields
from bladecad.errors import DataError

Kind = Literal["scan", "sections"]
FEWEST: Final = 8  # points of a loop
SOLID: Final = b"ISO-10303-21"  # how a STEP file begins
WAY: Final = 10.0  # times the size of a loop: the way along its points; 2 to 3 on an airfoil


def kind_of(path: Path) -> Kind:
    """Tell whether a file holds a scan or sections.

    Meshes and clouds are scans. Rows of numbers alone are sections where blank lines or headings
    part them into loops, or where the file is one loop of a numbered family. What cannot be read
    at all is left to the reader of sections, which says why.

    Raises
    ------
    DataError
        If the content is not the mesh that the suffix promises, or a solid already.
    """
    if path.is_dir() or not path.is_file() or not path.stat().st_size:
        return "sections"
    _refuse_solid(path)
    if mesh_format(path):
        return "scan"
    if holds_sections(path):
        return "sections"
    try:
        layout = layout_of(path)
    except DataError:
        return "sections"
    return "sections" if _loops(path, layout) else "scan"


def _refuse_solid(path: Path) -> None:
    with path.open("rb") as file:
        start = file.read(256)
    if start.lstrip().startswith(SOLID):
        raise DataError(
            f"{path.name} is a STEP file, a solid already; give what was measured, or check a scan "
            "against it: bladecad check"
        )


def _loops(path: Path, layout: Layout) -> bool:
    """Whether plain rows of numbers are loops, one after the other or one a file."""
    with path.open("rb") as file:
        head, more = file.read(HEAD), bool(file.read(1))
    text = Text(path, tuple(head.decode("utf-8-sig", errors="replace").splitlines()))
    groups = blocks(text)
    groups = groups[:-1] if more else groups
    family = not more and len(groups) == 1 and len(siblings(path)) > 1
    if len(groups) < 2 and not family:
        return False
    return all(_is_loop(_points(text, group, layout)) for group in groups)


def _points(text: Text, group: Block, layout: Layout) -> Points:
    rows = [fields(text.lines[row].replace(",", ".") if layout.commas else text.lines[row])
            for row in group.rows]  # fmt: skip
    found = [[_number(row[k]) for k in layout.columns] for row in rows if len(row) >= layout.width]
    return np.array(found, dtype=np.float64).reshape(-1, 3)


def _number(word: str) -> float:
    try:
        return float(word)
    except ValueError:
        return np.nan


def _is_loop(points: Points) -> bool:
    """Whether points follow each other along a line that goes round, and are not strewn."""
    points = points[np.isfinite(points).all(axis=1)]
    if len(points) < FEWEST:
        return False
    steps: Array = np.linalg.norm(np.diff(points, axis=0), axis=1)
    return bool(steps.sum() < WAY * np.linalg.norm(np.ptp(points, axis=0)))
