"""ANSYS TurboGrid: `profile.curve` of loops, its `.inf`, and hub and shroud curves.

    # Profile 1 at 0.0000%
    17.6667508  -2.09768896  0.0306973  le1

Text after `#` is free, `##` is a comment. Tags le1, le2, te1, te2 mark the edges, two a blunt one.
Which side the loops run along first, from the leading edge, stands in a comment where it is known.
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from bladecad.arrays import Array, Vector
from bladecad.data import beside
from bladecad.data.blocks import Block, blocks
from bladecad.data.draft import Draft
from bladecad.data.loops import edge_tags, loop
from bladecad.data.sections import Arc, Section, Sections
from bladecad.data.table import AXES, UNITS
from bladecad.data.text import Text, fields, read_text, table, write_text
from bladecad.errors import DataError

TAGS = ("le", "le1", "le2", "te", "te1", "te2")
ORDER: Final = "## in loop order, from the leading to the trailing edge: "
SIDES: Final[dict[str, Arc]] = {"suction side": "first", "pressure side": "second"}


def recognises(text: Text) -> bool:
    """Whether sections stand under `# ... Profile` headings, or points carry edge tags."""
    if text.path.suffix.lower() in (".curve", ".crv"):
        return bool(blocks(text))
    return any(
        (line.startswith("#") and "profile" in line.lower()) or fields(line.lower())[-1] in TAGS[1:]
        for line in text.lines
    )


def recognises_inf(text: Text) -> bool:
    """Whether the text names a profile data file."""
    return "profile data file" in _keys(text)


def read(text: Text) -> Draft:
    """Read the sections of a profile, with what the `.inf` beside it says."""
    suction = _suction(text)
    sections = tuple(_section(text, block, k, suction) for k, block in enumerate(blocks(text), 1))
    inf = _inf_of(text.path)
    keys = _keys(inf) if inf else {}
    draft = Draft(
        "TurboGrid",
        sections,
        unit=UNITS.get(keys.get("geometry units", "").lower()),
        axis=AXES.get(keys.get("axis of rotation", "").lower()),
        blade_count=_count(keys, "number of blade sets"),
        hub=_curve(text.path, keys, "hub"),
        shroud=_curve(text.path, keys, "shroud"),
    )
    if (_count(keys, "number of blades per set") or 1) > 1:
        return draft.noted("the row has splitters; only the blade of this profile was read")
    return draft


def read_inf(text: Text) -> Draft:
    """Read the profile that an `.inf` names; its path may point into another tree."""
    named = _keys(text)["profile data file"]
    profile = beside.find(text.path.parent, named, text.path.name)
    if profile is None:
        raise DataError(
            f'{text.path.name} names the profile "{named}", which is not in '
            f"{text.path.parent}; put it beside the .inf"
        )
    return read(read_text(profile))


def write_turbogrid(sections: Sections, path: Path) -> None:
    """Write profile, `.inf`, hub and shroud, in mm, under the name of `path`."""
    write_text(path, _order(sections) + "\n".join(_profile(s) for s in sections.sections))
    curves = {"hub": sections.row.hub, "shroud": sections.row.shroud}
    names = {word: f"{path.stem}_{word}{path.suffix}" for word, zr in curves.items() if len(zr)}
    for word, name in names.items():
        write_text(path.with_name(name), _curve_text(curves[word], sections.axis))
    keys = [
        "!======  CFX-BladeGen Export  ========",
        f"Axis of Rotation: {sections.source.axis.upper()}",
    ]
    if sections.row.blade_count:
        keys += [f"Number of Blade Sets: {sections.row.blade_count}", "Number of Blades Per Set: 1"]
    keys += ["Geometry Units: MM", "Coordinate System Orientation: Righthanded"]
    keys += [f"{word.capitalize()} Data File: {name}" for word, name in names.items()]
    keys += [f"Profile Data File: {path.name}", "Blade Loft Direction: Spanwise"]
    write_text(path.with_suffix(".inf"), "\n".join(keys) + "\n")


def _section(text: Text, block: Block, k: int, suction: Arc | None) -> Section:
    last = [fields(text.lines[i].lower())[-1] for i in block.rows]
    tags = {i: tag for i, tag in enumerate(last) if tag in TAGS}
    section = loop(block.name(f"{k}"), table(text, block.rows), tags)
    return replace(section, suction=suction if section.le and section.te else None)


def _suction(text: Text) -> Arc | None:
    """Which arc is the suction side, as the comment of `write_turbogrid` says."""
    said = [re.sub(r"\s+", " ", line).strip().lower() for line in text.lines]
    return next((arc for side, arc in SIDES.items() if f"{ORDER}{side}" in said), None)


def _order(sections: Sections) -> str:
    """The comment on the sides; none where they are not known or differ from loop to loop."""
    known = {s.suction if s.le and s.te else None for s in sections.sections}
    said = [f"{ORDER}{side}\n" for side, arc in SIDES.items() if known == {arc}]
    return "".join(said)


def _keys(text: Text) -> dict[str, str]:
    pairs = (line.split(":", 1) for line in text.lines if ":" in line and line[0] not in "!#")
    return {key.strip().lower(): value.strip() for key, value in pairs}


def _inf_of(profile: Path) -> Text | None:
    """Return the `.inf` that names this profile, else the only one in the folder."""
    found = [read_text(p) for p in sorted(profile.parent.glob("*.[iI][nN][fF]"))]
    for text in found:
        named = _keys(text).get("profile data file", "")
        if named and beside.find(profile.parent, named, text.path.name) == profile:
            return text
    return found[0] if len(found) == 1 else None


def _count(keys: dict[str, str], key: str) -> int | None:
    value = keys.get(key, "")
    return int(value) if value.isdigit() else None


def _curve(profile: Path, keys: dict[str, str], word: str) -> Array:
    named = keys.get(f"{word} data file", "")
    path = beside.find(profile.parent, named, profile.name) if named else None
    return beside.read_curve(path) if path else np.empty((0, 2))


def _profile(section: Section) -> str:
    tags = edge_tags(section)
    rows = [f"{_xyz(p)} {tags.get(i, '')}".rstrip() for i, p in enumerate(section.points)]
    rows += [_xyz(section.points[0])] if section.closed else []
    return "\n".join([f"# {section.name}", *rows, ""])


def _curve_text(zr: Vector, axis: int) -> str:
    points = np.insert(np.column_stack([np.zeros(len(zr)), zr[:, 1]]), axis, zr[:, 0], axis=1)
    return "\n".join(map(_xyz, points)) + "\n"


def _xyz(point: Array) -> str:
    return f"{point[0]:.10g} {point[1]:.10g} {point[2]:.10g}"
