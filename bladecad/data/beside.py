"""What lies in the folder beside the sections: hub and shroud curves, a note on units and axis."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np

from bladecad.arrays import Array
from bladecad.data.draft import Draft
from bladecad.data.sections import MM_PER, Axis, Row, Unit
from bladecad.data.table import AXES, UNITS, read_table
from bladecad.data.text import is_row, numbers, read_text, write_text
from bladecad.errors import DataError

Curves = tuple[Array, Array]


def hub_and_shroud(path: Path, unit: Unit | None) -> Curves:
    """Return `hub_shroud.csv` beside the sections, in their unit; empty where there is none.

    Columns `curve,z_mm,r_mm`, curve being `hub` or `shroud`, z the axial position.
    """
    for name in (f"{path.stem}_hub_shroud.csv", "hub_shroud.csv"):
        if path.with_name(name).is_file():
            table = read_table(read_text(path.with_name(name)))
            own = table.unit("z", "r")
            scale = MM_PER[own] / MM_PER[unit] if own and unit else 1.0
            zr, curve = table.values("z", "r") * scale, np.array(table.labels("curve"))
            return zr[curve == "hub"], zr[curve == "shroud"]
    return np.empty((0, 2)), np.empty((0, 2))


def write_hub_and_shroud(row: Row, path: Path) -> None:
    """Write `<name>_hub_shroud.csv` beside `path`, in mm."""
    lines = ["curve,z_mm,r_mm"]
    for name, curve in (("hub", row.hub), ("shroud", row.shroud)):
        lines += [f"{name},{z:.10g},{r:.10g}" for z, r in curve]
    write_text(path.with_name(f"{path.stem}_hub_shroud.csv"), "\n".join(lines) + "\n")


def told(draft: Draft, path: Path) -> Draft:
    """Return the draft completed by what `Info.txt`, hub and shroud beside it say."""
    unit, axis, count = read_info(path)
    hub, shroud = loose_curves(path)
    return replace(
        draft,
        unit=draft.unit or unit,
        axis=draft.axis or axis,
        blade_count=draft.blade_count or count,
        hub=draft.hub if len(draft.hub) else hub,
        shroud=draft.shroud if len(draft.shroud) else shroud,
    )


def loose_curves(path: Path) -> Curves:
    """Return hub and shroud from the files beside `path` that carry those words in their names.

    Each is (n, 2), axial position and radius, or (n, 3), points; empty where there is no one file.
    """
    return _curve_named(path, "hub"), _curve_named(path, "shroud")


def read_curve(path: Path) -> Array:
    """Return a curve of two or three columns, inlet to outlet; lines of words are passed over."""
    text = read_text(path)
    rows = [numbers(text, i) for i, line in enumerate(text.lines) if is_row(line)]
    width = len(rows[0]) if rows else 0
    if width not in (2, 3) or any(len(row) != width for row in rows):
        raise DataError(
            f"{path.name}: a curve needs two or three numbers on every line; correct it"
        )
    return np.array(rows)


def find(folder: Path, name: str, near: str = "") -> Path | None:
    """Return the file of that name, whatever tree it points into, or the one whose name ends so."""
    base = name.replace("\\", "/").rsplit("/", 1)[-1].strip().lower()
    files = [path for path in sorted(folder.iterdir()) if path.is_file()]
    exact = [path for path in files if path.name.lower() == base]
    ending = [path for path in files if base and path.name.lower().endswith(base)]
    ending.sort(key=lambda path: -likeness(path.name, near))
    return next(iter(exact + ending), None)


def read_info(path: Path) -> tuple[Unit | None, Axis | None, int | None]:
    """Return unit, axis and blade count as an `Info.txt` beside the sections tells them."""
    file = find(path.parent, "info.txt")
    said = "\n".join(read_text(file).lines) if file else ""
    unit = re.search(r"unit\w*\s*[:=]\s*(\w+)", said, re.IGNORECASE)
    axis = re.search(r"axis[^:=\n]*[:=]\s*([xyz])\b", said, re.IGNORECASE)
    count = re.search(r"blades[^:=\n]*[:=]\s*(\d+)", said, re.IGNORECASE)
    return (
        UNITS.get(unit[1].lower()) if unit else None,
        AXES.get(axis[1].lower()) if axis else None,
        int(count[1]) if count else None,
    )


def _curve_named(path: Path, word: str) -> Array:
    named = [
        file
        for file in path.parent.iterdir()
        if word in file.stem.lower() and file.suffix.lower() in (path.suffix.lower(), ".dat")
        and not ("hub" in file.stem.lower() and "shroud" in file.stem.lower())
    ]  # fmt: skip
    return read_curve(named[0]) if len(named) == 1 else np.empty((0, 2))


def likeness(a: str, b: str) -> int:
    """Return how many first letters two names share."""
    pairs = enumerate(zip(a, b, strict=False))
    return next((i for i, (x, y) in pairs if x != y), min(len(a), len(b)))
