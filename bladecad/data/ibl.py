"""Creo `.ibl`: `begin section`, `begin curve`, points with or without an index before them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from bladecad.arrays import Points
from bladecad.data.blocks import Block, blocks
from bladecad.data.draft import Draft
from bladecad.data.loops import loop, two_sides
from bladecad.data.sections import Section, Sections
from bladecad.data.text import Text, numbers, table, write_text


def recognises(text: Text) -> bool:
    """Whether curves are begun in sections."""
    starts = {" ".join(line.lower().split()[:2]) for line in text.lines}
    return {"begin section", "begin curve"} <= starts


def read(text: Text) -> Draft:
    """Read each section; one of two curves has its sides, each from the leading edge."""
    bare = Text(text.path, tuple(line.split("!")[0] for line in text.lines))
    curves: list[list[Points]] = []
    for block in blocks(bare):
        if (
            any("begin section" in " ".join(h.lower().split()) for h in block.headings)
            or not curves
        ):
            curves.append([])
        curves[-1].append(_curve(bare, block))
    return Draft("Creo ibl", tuple(_section(f"{k}", c) for k, c in enumerate(curves, 1)))


def write_ibl(sections: Sections, path: Path) -> None:
    """Write one curve a section, in mm; the first point is repeated, as `closed` demands."""
    closed = all(s.closed for s in sections.sections)
    lines = ["closed" if closed else "open", "arclength"]
    for k, section in enumerate(sections.sections, 1):
        points = np.vstack([section.points, section.points[: int(section.closed)]])
        lines += ["", f"begin section ! {k}", f"begin curve ! {k}"]
        lines += [f"{i} {x:.10g} {y:.10g} {z:.10g}" for i, (x, y, z) in enumerate(points, 1)]
    write_text(path, "\n".join(lines) + "\n")


def _curve(text: Text, block: Block) -> Points:
    return table(text, block.rows, skip=1 if len(numbers(text, block.rows[0])) == 4 else 0)


def _section(name: str, curves: list[Points]) -> Section:
    if len(curves) == 2:
        return two_sides(name, *curves)
    joined = np.vstack(curves)
    return loop(name, joined[np.append(True, np.diff(joined, axis=0).any(axis=1))])
