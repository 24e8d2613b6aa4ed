"""What is known of a blade before anything is fitted to it, in plain numbers and words."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from bladecad.arrays import Vector
from bladecad.curves.odd import odd_sections
from bladecad.curves.outliers import Misprint, noise
from bladecad.curves.properties import SectionProperties, properties
from bladecad.curves.sides import BladeLines
from bladecad.data.sections import Section, Sections

LIES = {"plane": "in planes", "revolution": "on stream surfaces"}


def as_dict(
    sections: Sections, lines: BladeLines, *, misprints: Sequence[Misprint] = ()
) -> dict[str, Any]:
    """Return what `describe` tells, in mm and degrees, for JSON.

    Parameters
    ----------
    sections : Sections
        As `repaired` returned them.
    lines : BladeLines
        Of the same sections.
    misprints : sequence of Misprint
        Points set aside before the sides were split.
    """
    source, row = sections.source, sections.row
    found = properties(lines, sections.axis)
    kinds = [outline.flat.kind for outline in lines.outlines]
    steps = np.concatenate([_spacing(section) for section in sections.sections])
    return {
        "file": source.path.name if source.path else None,
        "format": source.format,
        "unit": source.unit,
        "unit_from": source.unit_from,
        "axis": source.axis,
        "axis_from": source.axis_from,
        "lies": " and ".join(LIES[kind] for kind in sorted(set(kinds))),
        "closed": all(section.closed for section in sections.sections),
        "leading_edge": lines.le,
        "trailing_edge": lines.te,
        "blade_count": row.blade_count,
        "hub": len(row.hub) > 0,
        "shroud": len(row.shroud) > 0,
        "spacing_mm": [float(v) for v in (steps.min(), np.median(steps), steps.max())],
        "noise_mm": noise(sections),
        "notes": [*source.notes, *lines.notes],
        "misprints": [str(one) for one in misprints],
        "odd_sections": [str(one) for one in odd_sections(found)],
        "sections": [
            _section(one, section) for one, section in zip(found, sections.sections, strict=True)
        ],
    }


def _section(found: SectionProperties, section: Section) -> dict[str, Any]:
    return {
        "name": found.name,
        "points": len(section.points),
        "span": found.span,
        "chord_mm": found.chord,
        "stagger_deg": float(np.degrees(found.stagger)),
        "thickness_mm": found.thickness,
        "thickness_place": found.thickness_place,
        "camber": found.camber,
        "turning_deg": float(np.degrees(found.turning)),
        "le_radius_mm": found.le_radius,
        "te_radius_mm": found.te_radius,
        "perimeter_mm": found.perimeter,
        "area_mm2": found.area,
        "centroid_mm": [float(v) for v in found.centroid],
    }


def _spacing(section: Section) -> Vector:
    ends = np.roll(section.points, -1, axis=0)
    steps = np.linalg.norm(ends - section.points, axis=1)
    return np.asarray(steps if section.closed else steps[:-1])
