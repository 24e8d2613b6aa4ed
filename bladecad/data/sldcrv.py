"""SolidWorks `.sldcrv`: bare points of one curve, so one section a file, numbered.

    176.697245	-20.683810	0.281091

A closed curve has its first point repeated at the end. "Curve through XYZ points" draws a spline
through them all, in the unit of the part.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from bladecad.data import beside
from bladecad.data.blocks import blocks
from bladecad.data.draft import Draft
from bladecad.data.loops import loop
from bladecad.data.sections import Section, Sections
from bladecad.data.text import Text, table, write_text
from bladecad.errors import DataError


def recognises(text: Text) -> bool:
    """Whether the file is called a SolidWorks curve and holds rows of numbers."""
    return text.path.suffix.lower() == ".sldcrv" and bool(blocks(text))


def read(text: Text) -> Draft:
    """Read the one curve of a file; `Info.txt`, hub and shroud beside it are read too."""
    found = blocks(text)
    if len(found) > 1:
        raise DataError(
            f"{text.at(found[1].rows[0])}: a second curve begins, SolidWorks reads one a file; "
            "put each section into a file of its own"
        )
    section = loop(text.path.stem, table(text, found[0].rows))
    return beside.told(Draft("SolidWorks curve", (section,)), text.path)


def write_sldcrv(sections: Sections, path: Path) -> None:
    """Write a file for each section, in mm: `<name>_01.sldcrv` and so on, hub first."""
    digits = max(2, len(f"{len(sections.sections)}"))
    for k, section in enumerate(sections.sections, 1):
        file = path.with_name(f"{path.stem}_{k:0{digits}}{path.suffix}")
        write_text(file, _curve(section))


def _curve(section: Section) -> str:
    points = np.vstack([section.points, section.points[: int(section.closed)]])
    return "".join(f"{x:.10g}\t{y:.10g}\t{z:.10g}\n" for x, y, z in points)
