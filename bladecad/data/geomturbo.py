"""AutoGrid `.geomTurbo`: nested NI_BEGIN ... NI_END, z axial, both sides of every section.

Keywords are met in either case. The first blade of the row is the main blade; a splitter after it
is left out, with a note.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import islice
from typing import final

import numpy as np

from bladecad.arrays import Array, Points
from bladecad.data.draft import Draft
from bladecad.data.loops import two_sides
from bladecad.data.sections import MM_PER, Section, Unit
from bladecad.data.text import Text, fields, numbers, table
from bladecad.errors import DataError


@final
@dataclass(eq=False)
class _Node:
    """A block of the file: its words after NI_BEGIN, its own lines by index, the blocks in it."""

    words: tuple[str, ...]
    lines: list[int] = field(default_factory=list)
    children: list[_Node] = field(default_factory=list)

    def all(self, kind: str) -> Iterator[_Node]:
        """Yield every block of that kind below this one, in the order of the file."""
        for child in self.children:
            if child.words[:1] == (kind,):
                yield child
            yield from child.all(kind)


def recognises(text: Text) -> bool:
    """Whether the text opens as a turbo geometry."""
    return any(line.lower().split()[:1] == ["ni_begin"] for line in text.lines)


def read(text: Text) -> Draft:
    """Read the main blade of the first row."""
    root = _tree(text)
    row = next(root.all("nirow"), root)
    blades = list(row.all("niblade"))
    shape = next((g for blade in blades[:1] for g in blade.all("nibladegeometry")), None)
    if shape is None:
        raise DataError(f"{text.path.name}: its first row has no blade geometry; export it again")
    unit, scale = _unit(text, _line(text, shape, "units") or _line(text, root, "units-factor"))
    hub, shroud = (_channel(text, root, word) * scale for word in ("hub", "shroud"))
    draft = Draft(
        "AutoGrid geomTurbo",
        tuple(_sections(text, shape, scale)),
        unit=unit,
        axis="z",
        blade_count=_count(_value(text, row, "periodicity")),
        hub=hub,
        shroud=shroud,
    )
    if len(blades) > 1:
        left_out = f"{len(blades) - 1} splitter of the row left out"
        return draft.noted(f"the main blade was read; {left_out}")
    return draft


def _tree(text: Text) -> _Node:
    root = _Node(())
    open_nodes = [root]
    for i, line in enumerate(text.lines):
        words = line.lower().split()
        if words[:1] == ["ni_begin"]:
            node = _Node(tuple(words[1:]))
            open_nodes[-1].children.append(node)
            open_nodes.append(node)
        elif words[:1] == ["ni_end"] and len(open_nodes) > 1:
            open_nodes.pop()
        elif words:
            open_nodes[-1].lines.append(i)
    return root


def _line(text: Text, node: _Node, key: str) -> int | None:
    """Return the index of the block's own line that starts with the key."""
    return next((i for i in node.lines if text.lines[i].lower().split()[0] == key), None)


def _value(text: Text, node: _Node, key: str) -> str:
    i = _line(text, node, key)
    return " ".join(text.lines[i].split()[1:]) if i is not None else ""


def _count(value: str) -> int | None:
    return int(value) if value.isdigit() else None


def _unit(text: Text, line: int | None) -> tuple[Unit, float]:
    """Return the unit of so many metres, and what is left of the factor; metres if not said."""
    mm = 1000 * (numbers(text, line, skip=1, count=1)[0] if line is not None else 1.0)
    same = [unit for unit, size in MM_PER.items() if abs(size - mm) < 1e-9 * mm]
    return (same[0], 1.0) if same else ("mm", mm)


def _sections(text: Text, shape: _Node, scale: float) -> Iterable[Section]:
    sides: dict[str, list[Points]] = {"suction": [], "pressure": []}
    side, lines = "", iter(shape.lines)
    for i in lines:
        word = text.lines[i].strip().lower()
        if word in sides:
            side = word
        elif word in ("xyz", "zrth") and side:
            count = max(0, int(numbers(text, next(lines, i))[0]))
            rows = tuple(islice(lines, count))
            if len(rows) < count:
                raise DataError(
                    f"{text.at(i)}: {count} points announced, {len(rows)} follow; export it again"
                )
            sides[side].append(_cartesian(word, table(text, rows)) * scale)
    if not sides["suction"] or len(sides["suction"]) != len(sides["pressure"]):
        raise DataError(
            f"{text.path.name}: {len(sides['suction'])} suction and {len(sides['pressure'])} "
            "pressure sections, as many of each are needed; export the blade again"
        )
    pairs = zip(sides["suction"], sides["pressure"], strict=True)
    return [two_sides(f"{k}", s, p, suction="first") for k, (s, p) in enumerate(pairs, 1)]


def _cartesian(kind: str, rows: Array) -> Points:
    if kind == "xyz":
        return rows
    z, r, angle = (rows[:, kind.index(letter)] for letter in "zrt")
    return np.column_stack([r * np.cos(angle), r * np.sin(angle), z])


def _channel(text: Text, root: _Node, word: str) -> Array:
    """Return the axial position and radius along hub or shroud, its basic curves chained."""
    curves = {_value(text, c, "name"): _zr(text, c) for c in root.all("basic_curve")}
    chains = [c for c in root.all("channel_curve") if word in c.words]
    found = [fields(text.lines[i]) for chain in chains for i in chain.lines]
    names = dict.fromkeys(f[2] for f in found if f[0].lower() == "vertex" and len(f) > 2)
    chain = np.vstack([np.empty((0, 2)), *(curves[name] for name in names if name in curves)])
    return (
        chain[np.append(True, np.any(np.diff(chain, axis=0) != 0, axis=1))] if len(chain) else chain
    )


def _zr(text: Text, curve: _Node) -> Array:
    lines = [i for inner in curve.all("zrcurve") for i in inner.lines]
    return table(text, tuple(i for i in lines[2:]), count=2)
