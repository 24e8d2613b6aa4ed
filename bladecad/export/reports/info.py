"""What `bladecad info` says: a header of what was read, and a table with a row per section."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from bladecad.curves.outliers import Misprint
from bladecad.curves.sides import BladeLines
from bladecad.data.sections import Sections
from bladecad.export.reports.facts import as_dict

__all__ = ["as_dict", "describe"]

FROM = {"file": "from the file", "option": "as asked", "default": "taken, the file does not say"}
COLUMNS = (
    # head, key, format
    ("section", "name", "{}"),
    ("points", "points", "{}"),
    ("u", "span", "{:.3f}"),
    ("chord", "chord_mm", "{:.3f}"),
    ("stagger", "stagger_deg", "{:.2f}"),
    ("thick", "thickness_mm", "{:.3f}"),
    ("at", "thickness_place", "{:.3f}"),
    ("camber", "camber", "{:.4f}"),
    ("turning", "turning_deg", "{:.1f}"),
    ("LE radius", "le_radius_mm", "{:.3f}"),
    ("TE radius", "te_radius_mm", "{:.3f}"),
    ("area", "area_mm2", "{:.2f}"),
    ("centroid", "centroid_mm", "{0[0]:.2f} {0[1]:.2f} {0[2]:.2f}"),
)
LEGEND = (
    "lengths in mm, area in mm2, angles in degrees; stagger against the machine axis; thickest "
    "place and camber as parts of the chord"
)


def describe(sections: Sections, lines: BladeLines, *, misprints: Sequence[Misprint] = ()) -> str:
    """Return what is known of a blade before anything is fitted to it, as text.

    Parameters are those of `as_dict`.
    """
    facts = as_dict(sections, lines, misprints=misprints)
    parts = [
        _header(facts),
        *_list("notes", facts["notes"]),
        *_list("points that do not fit, set aside", facts["misprints"]),
        *_list("sections that stand off the others", facts["odd_sections"]),
        "\n".join(_table(facts["sections"])),
        LEGEND,
    ]
    return "\n\n".join(parts) + "\n"


def _header(facts: dict[str, Any]) -> str:
    shortest, median, longest = facts["spacing_mm"]
    rows = {
        "file": facts["file"] or "none",
        "format": facts["format"],
        "sections": f"{len(facts['sections'])}, {_points(facts)}, {facts['lies']}",
        "unit": f"{facts['unit']} ({FROM[facts['unit_from']]})",
        "axis": f"{facts['axis']} ({FROM[facts['axis_from']]})",
        "outline": "closed" if facts["closed"] else "open between last and first point",
        "edges": f"leading {facts['leading_edge']}, trailing {facts['trailing_edge']}",
        "row": _row(facts),
        "spacing": f"{shortest:.3g} to {longest:.3g} mm, median {median:.3g} mm",
        "noise": f"{1000 * facts['noise_mm']:.2g} um, estimated from the points",
    }
    return "\n".join(f"{key:<9} {value}" for key, value in rows.items())


def _points(facts: dict[str, Any]) -> str:
    counts = sorted({section["points"] for section in facts["sections"]})
    return f"{counts[0]} points each" if len(counts) == 1 else f"{counts[0]} to {counts[-1]} points"


def _row(facts: dict[str, Any]) -> str:
    count = facts["blade_count"]
    curves = [name for name in ("hub", "shroud") if facts[name]]
    blades = f"{count} blades" if count else "blade count not said"
    return f"{blades}, {' and '.join(curves) or 'no hub or shroud'} given"


def _list(title: str, lines: Sequence[str]) -> list[str]:
    return ["\n".join([f"{title}:", *(f"  - {line}" for line in lines)])] if lines else []


def _table(rows: Sequence[dict[str, Any]]) -> list[str]:
    """Lines of a table, every column as wide as it needs to be, numbers to the right."""
    cells = [[_cell(row[key], form) for _, key, form in COLUMNS] for row in rows]
    heads = [head for head, _, _ in COLUMNS]
    widths = [max(len(line[i]) for line in [heads, *cells]) for i in range(len(heads))]
    return [
        "  ".join(
            [line[0].ljust(widths[0])]
            + [c.rjust(w) for c, w in zip(line[1:], widths[1:], strict=True)]
        )
        for line in [heads, *cells]
    ]


def _cell(value: Any, form: str) -> str:
    return "-" if value is None else form.format(value)
