"""NASA surface tables, as in AGARD AR-355: blocks `SURFACE NUMBER k`, rows `J Z R THETA1 THETA2`.

Both sides share their axial positions and radii; angles are radians about z. Which side is the
suction side is not said.
"""

from __future__ import annotations

import re

import numpy as np

from bladecad.arrays import Array, Points
from bladecad.data.blocks import Block, blocks
from bladecad.data.draft import Draft
from bladecad.data.loops import two_sides
from bladecad.data.sections import Section, Unit
from bladecad.data.table import UNITS
from bladecad.data.text import Text, is_row, numbers, read_text, table


def recognises(text: Text) -> bool:
    """Whether surfaces are numbered and their columns are Z, R and two angles."""
    said = "\n".join(text.lines).upper()
    return "SURFACE NUMBER" in said and re.search(r"\bZ\s+R\s+THETA", said) is not None


def read(text: Text) -> Draft:
    """Read the surfaces, and hub and shroud from a file beside them."""
    unit = _unit(text)
    hub, shroud = _hub_and_shroud(text)
    return Draft(
        "NASA surface table",
        tuple(_section(text, block, k) for k, block in enumerate(blocks(text), 1)),
        unit=unit,
        axis="z",
        hub=hub,
        shroud=shroud,
        cylindrical=True,
    )


def _section(text: Text, block: Block, k: int) -> Section:
    z, r, *angles = table(text, block.rows, skip=1, count=4).T
    said = re.search(r"SURFACE NUMBER\s+(\d+)", " ".join(block.headings), re.IGNORECASE)
    return two_sides(said[1] if said else f"{k}", *(_about_z(z, r, angle) for angle in angles))


def _about_z(z: Array, r: Array, angle: Array) -> Points:
    return np.column_stack([r * np.cos(angle), r * np.sin(angle), z])


def _unit(text: Text) -> Unit | None:
    words = re.findall(r"[a-z]+", " ".join(text.lines[:20]).lower())
    return next((UNITS[word] for word in words if word in UNITS and len(word) > 2), None)


def _hub_and_shroud(text: Text) -> tuple[Array, Array]:
    """Return the curves of a file beside it: lists headed Zhub, Rhub, Zshroud, Rshroud."""
    beside = [p for p in text.path.parent.glob("*hub*shroud*") if p.suffix == text.path.suffix]
    lists: dict[str, list[float]] = {}
    key = ""
    for said in map(read_text, beside[:1]):
        for i, line in enumerate(said.lines):
            key = line.strip().lower() if re.fullmatch(r"\s*[ZR]\w+\s*", line) else key
            if key and is_row(line):
                lists.setdefault(key, []).extend(numbers(said, i))
    return _curve(lists, "hub"), _curve(lists, "shroud")


def _curve(lists: dict[str, list[float]], word: str) -> Array:
    z, r = lists.get(f"z{word}", []), lists.get(f"r{word}", [])
    return np.column_stack([z, r]) if len(z) == len(r) else np.empty((0, 2))
