"""Creo `.ibl`: `begin section`, `begin curve`, points with or without an index before them.

    begin curve ! le 1 te 41 suction first

Where edges and sides are known they stand behind the `!`, points numbered from 1: for Creo, and for
readers that draw one spline, a section stays one curve.
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np

from bladecad.arrays import Points
from bladecad.data.blocks import Block, blocks
from bladecad.data.draft import Draft
from bladecad.data.loops import loop, two_sides
from bladecad.data.sections import Arc, Section, Sections
from bladecad.data.text import Text, numbers, table, write_text


def recognises(text: Text) -> bool:
    """Whether curves are begun in sections."""
    starts = {" ".join(line.lower().split()[:2]) for line in text.lines}
    return {"begin section", "begin curve"} <= starts


def read(text: Text) -> Draft:
    """Read each section; one of two curves has its sides, each from the leading edge."""
    bare = Text(text.path, tuple(line.split("!")[0] for line in text.lines))
    curves: list[list[Points]] = []
    marks: list[str] = []
    for block in blocks(bare):
        if (
            any("begin section" in " ".join(h.lower().split()) for h in block.headings)
            or not curves
        ):
            curves.append([])
            marks.append(_mark(text, block))
        curves[-1].append(_curve(bare, block))
    pairs = enumerate(zip(curves, marks, strict=True), 1)
    return Draft("Creo ibl", tuple(_section(f"{k}", c, mark) for k, (c, mark) in pairs))


def write_ibl(sections: Sections, path: Path) -> None:
    """Write one curve a section, in mm; the first point is repeated, as `closed` demands."""
    closed = all(s.closed for s in sections.sections)
    lines = ["closed" if closed else "open", "arclength"]
    for k, section in enumerate(sections.sections, 1):
        points = np.vstack([section.points, section.points[: int(section.closed)]])
        lines += ["", f"begin section ! {k}", f"begin curve ! {_marked(section) or k}"]
        lines += [f"{i} {x:.10g} {y:.10g} {z:.10g}" for i, (x, y, z) in enumerate(points, 1)]
    write_text(path, "\n".join(lines) + "\n")


def _curve(text: Text, block: Block) -> Points:
    return table(text, block.rows, skip=1 if len(numbers(text, block.rows[0])) == 4 else 0)


def _section(name: str, curves: list[Points], mark: str) -> Section:
    if len(curves) == 2:
        return two_sides(name, *curves)
    joined = np.vstack(curves)
    section = loop(name, joined[np.append(True, np.diff(joined, axis=0).any(axis=1))])
    return _as_marked(section, mark) if len(curves) == 1 else section


def _mark(text: Text, block: Block) -> str:
    """What stands behind the `!` of the line that begins the curve."""
    above = reversed(text.lines[: block.rows[0]])
    return next((line.partition("!")[2] for line in above if line.strip()), "")


def _marked(section: Section) -> str:
    """Edges and sides of a section; empty where an edge is not known."""
    if not section.le or not section.te:
        return ""
    le, te = (" ".join(str(i + 1) for i in corners) for corners in (section.le, section.te))
    return f"le {le} te {te}" + (f" suction {section.suction}" if section.suction else "")


def _as_marked(section: Section, mark: str) -> Section:
    found = re.fullmatch(r"\s*le ([\d ]+) te ([\d ]+?)(?: suction (first|second))?\s*", mark)
    if not found:
        return section
    le, te = (tuple(int(word) - 1 for word in found[k].split()) for k in (1, 2))
    suction: Arc | None = "first" if found[3] == "first" else "second" if found[3] else None
    return replace(section, le=le, te=te, suction=suction)
