"""bladecad's own table: `section,side,x_mm,y_mm,z_mm`, or closed loops without the side.

    # z axial, 36 blades
    section,side,x_mm,y_mm,z_mm
    1,suction,176.697245,-20.683810,0.281091

Sides are `suction` and `pressure`, or any two names where it is not known which is which; each runs
from the leading to the trailing edge. Loops may mark their edge points `le`, `te` (`le1`, `le2`
where blunt) in a column `edge`. Other units stand in the headers: `x_in`, `y_in`, `z_in`.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array
from bladecad.data import beside
from bladecad.data.draft import Draft
from bladecad.data.loops import arcs, edge_tags, loop, two_sides
from bladecad.data.sections import Arc, Axis, Section, Sections
from bladecad.data.table import AXES, Table, header_of, read_table
from bladecad.data.text import Text, write_text
from bladecad.errors import DataError

SUCTION = ("suction", "suction side", "suction_side", "ss")
PRESSURE = ("pressure", "pressure side", "pressure_side", "ps")


def recognises(text: Text) -> bool:
    """Whether the header names a coordinate x, y or z."""
    return any(re.fullmatch(r"[xyz]([_ \[(]+\w+[\])]?)?", word) for word in header_of(text)[1])


def read(text: Text) -> Draft:
    """Read sections from a table."""
    table = read_table(text)
    points, unit = table.values("x", "y", "z"), table.unit("x", "y", "z")
    hub, shroud = beside.hub_and_shroud(text.path, unit)
    draft = Draft(
        "table of points",
        tuple(_sections(table, points)),
        unit=unit,
        axis=_axis(text),
        blade_count=_blade_count(text),
        hub=hub,
        shroud=shroud,
    )
    return draft if "section" in table.columns else beside.told(draft, text.path)


def write_csv(sections: Sections, path: Path) -> None:
    """Write sections in mm: by side where all edges are known, else as loops.

    Hub and shroud go to `<name>_hub_shroud.csv` beside it.
    """
    about, blades = sections.source.axis, sections.row.blade_count
    lines = [f"# {about} axial" + (f", {blades} blades" if blades else "")]
    sided = all(s.closed and arcs(s) for s in sections.sections)
    tagged = any(s.le or s.te for s in sections.sections)
    mark = "side," if sided else "edge," if tagged else ""
    lines += [f"section,{mark}x_mm,y_mm,z_mm"]
    for section in sections.sections:
        lines += _side_rows(section) if sided else _loop_rows(section, tagged)
    write_text(path, "\n".join(lines) + "\n")
    if len(sections.row.hub) or len(sections.row.shroud):
        beside.write_hub_and_shroud(sections.row, path)


def _sections(table: Table, points: Array) -> Iterable[Section]:
    names = table.labels("section") if "section" in table.columns else table.groups
    sides = table.labels("side") if "side" in table.columns else None
    edges = table.labels("edge") if "edge" in table.columns else None
    for name in dict.fromkeys(names):
        rows = [i for i, other in enumerate(names) if other == name]
        if sides:
            yield _sided(name, points[rows], np.array([sides[i].lower() for i in rows]))
        else:
            tags = {k: edges[i] for k, i in enumerate(rows) if edges[i]} if edges else {}
            yield loop(name, points[rows], tags)


def _sided(name: str, points: Array, sides: NDArray[np.str_]) -> Section:
    found = list(dict.fromkeys(sides.tolist()))
    if len(found) != 2:
        raise DataError(
            f'section "{name}": sides {", ".join(map(repr, found))}, two are needed; '
            "name them suction and pressure"
        )
    first, second = (points[sides == side] for side in found)
    return two_sides(name, first, second, suction=_suction(found))


def _suction(found: list[str]) -> Arc | None:
    if found[0] in SUCTION or found[1] in PRESSURE:
        return "first"
    return "second" if found[0] in PRESSURE or found[1] in SUCTION else None


def _axis(text: Text) -> Axis | None:
    match = re.search(r"\b([xyz])[ -]axial|axis[ :=]+([xyz])\b", _comments(text), re.IGNORECASE)
    return AXES.get((match[1] or match[2]).lower()) if match else None


def _blade_count(text: Text) -> int | None:
    match = re.search(r"\b(\d+) blades\b", _comments(text))
    return int(match[1]) if match else None


def _comments(text: Text) -> str:
    return "\n".join(line for line in text.lines if line.startswith("#"))


def _side_rows(section: Section) -> list[str]:
    names = {"first": ("suction", "pressure"), "second": ("pressure", "suction"), None: ("1", "2")}
    pair = zip(names[section.suction], arcs(section) or (), strict=True)
    return [_row(section.name, side, point) for side, points in pair for point in points]


def _loop_rows(section: Section, tagged: bool) -> list[str]:
    tags = edge_tags(section)
    marks = [tags.get(i, "") if tagged else None for i in (*range(len(section.points)), -1)]
    points = [*section.points, section.points[0]]
    rows = [_row(section.name, mark, p) for mark, p in zip(marks, points, strict=True)]
    return rows if section.closed else rows[:-1]


def _row(name: str, mark: str | None, point: Array) -> str:
    numbers = (f"{value:.10g}" for value in point)
    return ",".join([name.replace(",", " "), *([] if mark is None else [mark]), *numbers])
