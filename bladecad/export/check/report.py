"""report.json of a check, `bladecad-check/1`: `docs/report.md` explains each number."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, is_dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from bladecad.deviation.inspecting.inspection import Inspection, Worst
from bladecad.deviation.inspecting.zones import ZoneResult
from bladecad.deviation.sectioning.parameters import Number
from bladecad.deviation.sectioning.section_result import SectionResult
from bladecad.export.check.checked import Checked
from bladecad.export.check.fits import registration_numbers, section_fit_numbers
from bladecad.export.reports.report import file_entry, versions
from bladecad.tolerance import Band, Tolerances

SCHEMA: Final = "bladecad-check/1"
ENGINE: Final = ("bladecad", "numpy", "scipy", "numba", "trimesh", "plotly")

Report = dict[str, Any]


def check_report(check: Checked, *, files: Mapping[str, Path] | None = None) -> Report:
    """Return the report on a finished check.

    Parameters
    ----------
    check : Checked
    files : mapping, optional
        What each other file that was written is, to its path.
    """
    found = check.inspection
    return {
        "schema": SCHEMA,
        "name": check.name,
        "verdict": verdict(found),
        "settings": plain(check.settings),
        "inputs": plain(check.inputs),
        "notes": list(check.notes),
        "positive": "metal outside the nominal",
        "points": _points(found),
        "registration": registration_numbers(found.registration),
        "tolerances": _tolerances(found.tolerances),
        "coverage": _coverage(found),
        "zones": [zone_numbers(zone) for zone in found.zones],
        "worst": [worst_numbers(worst) for worst in found.worst],
        "sections": [section_numbers(section) for section in found.sections],
        "referee": referee_numbers(found),
        "files": [file_entry(kind, path) for kind, path in (files or {}).items()],
        "seconds": {step: round(s, 3) for step, s in found.seconds.items()},
        "versions": versions(ENGINE),
    }


def verdict(found: Inspection) -> Report:
    """Return the verdict: within or not, by how much, and every reason."""
    worst = found.worst[0] if found.worst else None
    return {
        "within": found.within,
        "reasons": list(found.reasons),
        "worst_excess_mm": worst.excess if worst else None,
    }


def zone_numbers(zone: ZoneResult) -> Report:
    """Return what was found on a zone; lengths in mm, areas in mm^2."""
    return {
        "zone": zone.name,
        "within": zone.within,
        "band_mm": band(zone.band),
        "points": zone.points,
        "out_points": zone.out_points,
        "allowed_out": zone.allowed_out,
        "area_mm2": zone.area,
        "measured_area_mm2": zone.measured_area,
        "out_area_mm2": zone.out_area,
        "coverage": zone.coverage if zone.area > 0.0 else None,
        "least_coverage": zone.least_coverage,
        "min_mm": zone.lowest,
        "max_mm": zone.highest,
        "mean_mm": zone.mean,
        "rms_mm": zone.rms,
        "p99_mm": zone.p99,
    }


def worst_numbers(worst: Worst) -> Report:
    """Return where a worst place is and how far out; points are numbered from 1."""
    return {
        "zone": worst.zone,
        "section": worst.section,
        "side": worst.side,
        "u": worst.u,
        "t": worst.t,
        "point_mm": worst.point,
        "point": worst.index + 1,
        "deviation_mm": worst.deviation,
        "excess_mm": worst.excess,
    }


def section_numbers(section: SectionResult) -> Report:
    """Return what was found on a section, its numbers and its fits among it."""
    known = section.deviation[section.measured]
    return {
        "section": section.name,
        "u": section.u,
        "points": section.points,
        "measured_share": float(section.measured.mean()) if len(section.t) else None,
        "min_mm": known.min() if len(known) else None,
        "max_mm": known.max() if len(known) else None,
        "rms_mm": np.sqrt(np.mean(known**2)) if len(known) else None,
        "numbers": [number_row(number) for number in section.numbers],
        "fits": [section_fit_numbers(fit) for fit in section.fits],
    }


def number_row(number: Number) -> Report:
    """Return one number of a section, in its own unit."""
    return {
        "name": number.name,
        "unit": number.unit,
        "nominal": number.nominal,
        "actual": number.actual,
        "deviation": number.deviation,
        "uncertainty": number.uncertainty,
        "band": band(number.band),
        "within": number.within,
        "sure": number.sure,
        "reason": number.reason,
    }


def band(band: Band | None) -> list[float] | None:
    """Return lower and upper bound."""
    return None if band is None else [band.lower, band.upper]


def referee_numbers(found: Inspection) -> Report | None:
    """Return how far trimesh agrees, or None where it was not asked."""
    if found.referee is None:
        return None
    return {
        "by": "trimesh.proximity",
        "points": found.referee.count,
        "disagreement_mm": found.referee.disagreement,
        "bound_mm": found.referee.bound,
    }


def plain(value: Any) -> Any:
    """Return dataclasses as mappings, at any depth; everything else as it is."""
    if is_dataclass(value) and not isinstance(value, type):
        return {key: plain(item) for key, item in _shallow(value).items()}
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, Sequence) and not isinstance(value, str):
        return [plain(item) for item in value]
    return value


def _shallow(value: Any) -> dict[str, Any]:
    return {name: getattr(value, name) for name in value.__dataclass_fields__}


def _points(found: Inspection) -> Report:
    return {
        "measured": len(found.zone),
        "inspected": len(found.zone) - found.beyond,
        "beyond_the_span": found.beyond,
        "unsettled": found.feet.unsettled,
        "out": sum(zone.out_points for zone in found.zones),
    }


def _coverage(found: Inspection) -> Report:
    chart = found.map
    return {
        "measured_share": chart.share,
        "area_mm2": chart.area.sum(),
        "not_measured_area_mm2": chart.area[~chart.measured].sum(),
        "cells": chart.count.size,
        "cells_measured": int(chart.measured.sum()),
    }


def _tolerances(tolerances: Tolerances) -> Report:
    content = asdict(tolerances)
    content["zones"] = {name: band(one) for name, one in tolerances.zones.items()}
    content["parameters"] = {name: band(one) for name, one in tolerances.parameters.items()}
    return content
