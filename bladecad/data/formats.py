"""Every way of writing sections that is read, from the most particular to the most general."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import final

from bladecad.data import (
    arcwise,
    csv,
    geomturbo,
    ibl,
    manufacturing,
    nominal_points,
    points,
    sldcrv,
    surfaces,
    turbogrid,
)
from bladecad.data.draft import Draft
from bladecad.data.text import Text, read_text
from bladecad.errors import DataError


@final
@dataclass(frozen=True)
class Format:
    """How sections are written down.

    name       : as the user is told
    suffixes   : the usual ones, lower case
    recognises : whether a text is written so
    read       : the reader
    numbered   : whether a blade may be a family of numbered files, one section in each
    """

    name: str
    suffixes: tuple[str, ...]
    recognises: Callable[[Text], bool]
    read: Callable[[Text], Draft]
    numbered: bool = False


PLAIN = (".txt", ".dat", ".xyz", ".pts", ".asc", ".csv", ".fpd")

FORMATS = (
    Format("AutoGrid geomTurbo", (".geomturbo",), geomturbo.recognises, geomturbo.read),
    Format("BladeGen .inf", (".inf",), turbogrid.recognises_inf, turbogrid.read_inf),
    Format("Creo .ibl", (".ibl",), ibl.recognises, ibl.read),
    Format("PC-DMIS nominal", (".nom",), nominal_points.recognises, nominal_points.read),
    Format("NASA manufacturing table", (".csv",), manufacturing.recognises, manufacturing.read),
    Format("NASA surface table", (".dat", ".txt"), surfaces.recognises, surfaces.read),
    Format(
        "R*THETA table", (".txt", ".csv", ".dat"), arcwise.recognises, arcwise.read, numbered=True
    ),
    Format("table of points", PLAIN, csv.recognises, csv.read, numbered=True),
    Format("TurboGrid", (".curve", ".crv"), turbogrid.recognises, turbogrid.read),
    Format("SolidWorks curve", (".sldcrv",), sldcrv.recognises, sldcrv.read, numbered=True),
    Format("points", PLAIN, points.recognises, points.read, numbered=True),
)

SUFFIXES = tuple(dict.fromkeys(suffix for form in FORMATS for suffix in form.suffixes))


def recognise(text: Text) -> Format:
    """Return the format of a text, by its content.

    Raises
    ------
    DataError
        If no format recognises it.
    """
    for form in FORMATS:
        if form.recognises(text):
            return form
    raise DataError(
        f"{text.path.name}: the content is none of {', '.join(form.name for form in FORMATS)}; "
        f"known suffixes are {', '.join(SUFFIXES)}; "
        "a plain table needs the header section,side,x_mm,y_mm,z_mm"
    )


def draft_of(path: Path) -> tuple[Format, Draft]:
    """Read one file; a suffix that does not fit the content is noted."""
    text = read_text(path)
    form = recognise(text)
    draft = form.read(text)
    if path.suffix.lower() not in form.suffixes:
        draft = draft.noted(f"{path.name}: read as {form.name}, from its content")
    return form, draft
