"""NASA manufacturing tables, as in TP-1337: plane sections by heights over the chord line.

Two tables go together, `name_points` and `name_sections`:

    section,radius_in,l_in,hp_in,hs_in
    section,radius_in,r_le_in,r_te_in,l_sp_in,h_sp_in,gamma_deg,l_max_in

A section lies in the plane normal to the stacking line at `radius`. Its pressure and suction side
have the heights hp and hs over l; the first and last row hold the edge radii, whose circles touch
both ends of l and h = 0. The stacking point (l_sp, h_sp) is on the stacking line, and l leans by
gamma from the machine axis. In space x is the stacking line, y tangential, z the machine axis.
"""

from __future__ import annotations

import numpy as np

from bladecad.arrays import Array, Points
from bladecad.data import beside
from bladecad.data.draft import Draft
from bladecad.data.edge_circles import Circle, lower_side, upper_side
from bladecad.data.loops import two_sides
from bladecad.data.sections import Section
from bladecad.data.table import Table, header_of, read_table
from bladecad.data.text import Text, read_text
from bladecad.errors import DataError

POINTS = ("section", "l", "hp", "hs")
SECTIONS = ("section", "radius", "r_le", "r_te", "l_sp", "h_sp", "gamma_deg", "l_max")


def recognises(text: Text) -> bool:
    """Whether the text is one of the two tables."""
    words = ",".join(header_of(text)[1])
    return all(word in words for word in ("hp", "hs", "section")) or "gamma_deg" in words


def read(text: Text) -> Draft:
    """Read both tables, given either; edge circles and the way to them are built."""
    points, sections = _pair(text)
    unit = sections.unit("radius", "r_le", "r_te", "l_sp", "h_sp", "l_max")
    if points.unit("l", "hp", "hs") != unit:
        raise DataError(f"{points.text.path.name}: its unit is not that of its fellow; use one")
    owner = np.array(points.labels("section"))
    heights = points.values("l", "hp", "hs")
    rows = zip(sections.labels("section"), sections.values(*SECTIONS[1:]), strict=True)
    built = [_section(name, row, heights[owner == name]) for name, row in rows]
    return Draft("NASA manufacturing table", tuple(built), unit=unit, axis="z").noted(
        "edge circles were built from their radii; between them and the next tabulated points the "
        "outline is the tangent spline of least bending"
    )


def _pair(text: Text) -> tuple[Table, Table]:
    """Return the table of points and the table of sections."""
    table = read_table(text)
    others = [p for p in text.path.parent.glob(f"*{text.path.suffix}") if p != text.path]
    others.sort(key=lambda p: -beside.likeness(p.name, text.path.name))
    for path in others:
        other = read_table(read_text(path))
        for points, sections in ((table, other), (other, table)):
            if set(POINTS) <= {*points.columns} and set(SECTIONS) <= {*sections.columns}:
                return points, sections
    wanted = SECTIONS if "hp" in table.columns else POINTS
    raise DataError(
        f"{text.path.name}: its fellow, a table with columns {', '.join(wanted)}, is not in "
        f"{text.path.parent}; put it there"
    )


def _section(name: str, row: Array, heights: Array) -> Section:
    radius, r_le, r_te, l_sp, h_sp, gamma, l_max = row
    between = (heights[:, 0] > 2 * r_le) & (heights[:, 0] < l_max - 2 * r_te)
    l, hp, hs = heights[between][np.argsort(heights[between, 0])].T  # noqa: E741
    if len(l) < 3:
        raise DataError(f'section "{name}": {len(l)} stations between the edges, 3 are needed')
    edges = Circle(r_le, r_le, r_le), Circle(l_max - r_te, r_te, r_te)
    upper = upper_side(np.column_stack([l, hs]), *edges)
    lower = lower_side(np.column_stack([l, hp]), *edges)
    stack = np.array([l_sp, h_sp])
    suction, pressure = (_place(side - stack, radius, np.radians(gamma)) for side in (upper, lower))
    return two_sides(name, suction, pressure, suction="first")


def _place(flat: Array, radius: float, gamma: float) -> Points:
    l, h = flat.T  # noqa: E741
    y = l * np.sin(gamma) + h * np.cos(gamma)
    z = l * np.cos(gamma) - h * np.sin(gamma)
    return np.column_stack([np.full(len(y), radius), y, z])
