"""PC-DMIS style nominal `.nom`: points and outward unit normals, section by section.

    UNITS MM
    NUM_SECT 2
    SECTION A 240 187.335
    NOSE 1
    TAIL 121
    176.697245 -20.683810 0.281091 -0.36 -0.93 0.02

NOSE and TAIL number the points of the leading and the trailing edge from 1; two numbers and SQUARE
mark a cut-off edge. The first point is not repeated at the end. Keywords are those of Hexagon's
PC-DMIS Blade help, "Nominal File Keywords".
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from bladecad.arrays import Points
from bladecad.data.draft import Draft
from bladecad.data.loops import loop
from bladecad.data.sections import Section, Sections
from bladecad.data.table import UNITS
from bladecad.data.text import Text, number, table, write_text
from bladecad.errors import DataError, ExportError

EDGES: Final = {"NOSE": "le", "TAIL": "te"}
UNIT: Final = 1e-3  # that the length of a normal may differ from 1


def recognises(text: Text) -> bool:
    """Whether a number of sections is announced, and sections follow."""
    return {"NUM_SECT", "SECTION"} <= {_words(line)[0] for line in text.lines}


def read(text: Text) -> Draft:
    """Read the points of all sections with their edges; `normals_of` reads the normals."""
    starts = _starts(text)
    said = {words[0]: words[1] for words in map(_words, text.lines) if len(words) > 1}
    count = int(number(said.get("NUM_SECT", ""), f"{text.path.name}, NUM_SECT"))
    if count != len(starts):
        raise DataError(
            f"{text.path.name}: NUM_SECT announces {count} sections, {len(starts)} follow; "
            "correct the number or complete the file"
        )
    normals_of(text)
    sections = tuple(_section(text, i) for i in starts)
    return Draft("PC-DMIS nominal", sections, unit=UNITS.get(said.get("UNITS", "").lower()))


def normals_of(text: Text) -> tuple[Points, ...]:
    """Read the outward unit normals of every section, (n, 3) each.

    Raises
    ------
    DataError
        If one is missing, or its length is not 1.
    """
    found = []
    for i in _starts(text):
        rows = _rows(text, i)
        normals = table(text, rows, skip=3)
        length = np.linalg.norm(normals, axis=1)
        for row in np.flatnonzero(np.abs(length - 1.0) > UNIT)[:1]:
            raise DataError(
                f"{text.at(rows[row])}: the normal is {length[row]:.4g} long, it must be 1; "
                "export the nominal again"
            )
        found.append(normals)
    return tuple(found)


def write_nominal(
    sections: Sections, path: Path, normals: Sequence[Points], heights: Sequence[float]
) -> None:
    """Write points and normals in mm, the edge points by number.

    Parameters
    ----------
    sections : Sections
    path : path
    normals : sequence of (n, 3) float
        Unit normals out of the metal, one array a section.
    heights : sequence of float
        Of the sections, mm.
    """
    lines = ["UNITS MM", f"NUM_SECT {len(sections.sections)}"]
    names = _names([section.name for section in sections.sections])
    for section, name, N, height in zip(sections.sections, names, normals, heights, strict=True):
        if len(N) != len(section.points):
            raise ExportError(
                f'section "{section.name}": {len(N)} normals for {len(section.points)} points'
            )
        lines += [f"SECTION {name} {len(section.points)} {height:.10g}"]
        lines += [_edge("NOSE", section.le), _edge("TAIL", section.te)]
        rows = np.hstack([section.points, N])
        lines += [" ".join(f"{value:.10g}" for value in row) for row in rows]
    write_text(path, "\n".join(line for line in lines if line) + "\n")


def _starts(text: Text) -> list[int]:
    return [i for i, line in enumerate(text.lines) if _words(line)[0] == "SECTION"]


def _rows(text: Text, start: int) -> tuple[int, ...]:
    """Lines of the points of the section that starts at a line."""
    words = _words(text.lines[start])
    count = int(number(words[2] if len(words) > 2 else "", text.at(start)))
    rows: list[int] = []
    for i in range(start + 1, len(text.lines)):
        word = _words(text.lines[i])[0]
        if word == "SECTION":
            break
        if word and word not in (*EDGES, "OFFSETS"):
            rows.append(i)
    if len(rows) != count:
        raise DataError(
            f"{text.at(start)}: {count} points announced, {len(rows)} follow; export it again"
        )
    return tuple(rows)


def _section(text: Text, start: int) -> Section:
    rows = _rows(text, start)
    tags: dict[int, str] = {}
    for i in range(start + 1, rows[0] if rows else start + 1):
        words = _words(text.lines[i])
        if words[0] in EDGES:
            places = [int(word) for word in words[1:3] if word.isdecimal()]
            if any(not 1 <= k <= len(rows) for k in places):
                raise DataError(
                    f"{text.at(i)}: point {max(places)} of {len(rows)}; correct the number"
                )
            tags |= {k - 1: f"{EDGES[words[0]]}{n}" for n, k in enumerate(places, 1)}
    section = loop(text.lines[start].split()[1], table(text, rows), tags)
    cut = (len(section.points) - 1, 0)
    return replace(section, closed=cut not in (section.le, section.te))


def _edge(word: str, corners: tuple[int, ...]) -> str:
    """The line of an edge; empty where it is not said."""
    said = " ".join(str(k + 1) for k in sorted(corners))
    return f"{word} {said}{' SQUARE' if len(corners) == 2 else ''}" if corners else ""


def _names(names: Sequence[str]) -> list[str]:
    """Names of letters and digits alone, as PC-DMIS wants them; numbers where they would clash.

    A decimal point becomes a p: r187.5 is r187p5.
    """
    plain = [re.sub(r"[^A-Za-z0-9]", "", name.replace(".", "p")) for name in names]
    clash = len(set(plain)) < len(plain) or not all(plain)
    return [f"S{k}" for k in range(1, len(names) + 1)] if clash else plain


def _words(line: str) -> list[str]:
    return line.upper().split() or [""]
