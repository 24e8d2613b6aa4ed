"""AutoGrid `.geomTurbo`, written: one row, one blade, both sides from the leading edge on."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from bladecad.arrays import Array, Points, Vector
from bladecad.data.loops import arcs
from bladecad.data.sections import Section, Sections
from bladecad.data.text import write_text
from bladecad.errors import ExportError

Lines = list[str]


def write_geomturbo(sections: Sections, path: Path) -> None:
    """Write a blade in metres, its axis turned to z where it is another.

    Raises
    ------
    ExportError
        If the file's sections do not say their edges and sides, which AutoGrid needs.
    """
    turn = 2 - sections.axis
    sides = [_sides(section, turn) for section in sections.sections]
    blade = ["units 1", *_count("number_of_blades", sections.row.blade_count)]
    for word, k in (("suction", 0), ("pressure", 1)):
        blade += [word, "SECTIONAL", f"{len(sides)}"]
        blade += [line for i, pair in enumerate(sides, 1) for line in _rows(i, pair[k])]
    geometry = _block("nibladegeometry", ["TYPE GEOMTURBO", *blade])
    row = ["NAME row 1", "TYPE normal", *_count("PERIODICITY", sections.row.blade_count)]
    row += _block("NIBlade", ["NAME Main Blade", *geometry])
    lines = ["GEOMETRY TURBO", "VERSION 5.5", *_channel(sections), *_block("nirow", row)]
    lines += ["NI_END GEOMTURBO", "", "NI_BEGIN GEOMETRY", "NI_END GEOMETRY"]
    write_text(path, "\n".join(lines) + "\n")


def _sides(section: Section, turn: int) -> tuple[Points, Points]:
    sides = arcs(section)
    if sides is None or section.suction is None:
        raise ExportError(
            f'section "{section.name}": AutoGrid needs suction and pressure side by name, they are '
            "not known; let bladecad convert find them with --on streams, or write .csv or .curve"
        )
    first, second = (np.roll(side, turn, axis=1) / 1000 for side in sides)
    return (first, second) if section.suction == "first" else (second, first)


def _channel(sections: Sections) -> Lines:
    curves = {"hub": sections.row.hub, "shroud": sections.row.shroud}
    lines: Lines = []
    for word, zr in curves.items():
        lines += _basic_curve(f"{word}_crv_1", zr / 1000) if len(zr) else []
    for word in (word for word, zr in curves.items() if len(zr)):
        ends = [f"VERTEX CURVE_P {word}_crv_1 {u}" for u in (0, 1)]
        lines += _block(f"channel_curve {word}", [f"NAME {word}", *ends])
    return _block("CHANNEL", lines)


def _basic_curve(name: str, zr: Vector) -> Lines:
    points = ["ZR", f"{len(zr)}", *map(_numbers, zr)]
    head = [f"NAME {name}", "DISCRETISATION 10", "DATA_REDUCTION 0"]
    return _block("basic_curve", [*head, *_block("zrcurve", points)])


def _rows(k: int, side: Points) -> Lines:
    return [f"# section {k}", "XYZ", f"{len(side)}", *map(_numbers, side)]


def _block(name: str, lines: Iterable[str]) -> Lines:
    return [f"NI_BEGIN {name}", *(f"  {line}" for line in lines), f"NI_END {name}"]


def _count(key: str, count: int | None) -> Lines:
    return [f"{key} {count}"] if count else []


def _numbers(values: Array) -> str:
    return " ".join(f"{value:.13g}" for value in values)
