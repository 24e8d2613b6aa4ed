"""The report: one verdict, and all the numbers it rests on; `docs/files.md` explains each."""

from __future__ import annotations

import hashlib
import platform
import sys
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, final

import numpy as np

from bladecad.curves.outliers import Misprint
from bladecad.data.sections import Sections
from bladecad.deviation.inspecting.measure import Deviation
from bladecad.export.cad.stl import StlFile
from bladecad.export.product import Asked, Product, between_sections
from bladecad.export.reports.report_fit import eigenvalues, fit_numbers
from bladecad.export.reports.report_rows import row_numbers
from bladecad.export.reports.report_solid import mesh_numbers, solid_numbers
from bladecad.fit.blade import BladeFit

if TYPE_CHECKING:
    from bladecad.brep.confirm import Agreement

SCHEMA: Final = "bladecad-report/1"
PACKAGES: Final = ("bladecad", "numpy", "scipy", "cadquery", "cadquery-ocp", "trimesh")

Report = dict[str, Any]


@final
@dataclass(frozen=True)
class Checks:
    """What was found when the files were read back.

    step : how far the STEP file is from the solid
    stl  : what the STL file holds
    """

    step: Agreement
    stl: StlFile


def report(product: Product, *, name: str, checks: Checks, files: Mapping[str, Path]) -> Report:
    """Return the report on a finished blade, whose files are written and read back.

    Parameters
    ----------
    product : Product
    name : str
    checks : Checks
    files : mapping
        What each file is, to its path.
    """
    head = _head(name, product.within, product.settings, product.reasons)
    if product.scanned is not None:
        head["verdict"]["partial"] = product.scanned.airfoil.partial is not None
    return {
        **head,
        "input": input_numbers(product.sections, product.lines.notes),
        "misprints": [_misprint(one) for one in product.misprints],
        "odd_sections": [str(one) for one in product.odd],
        "fit": fit_numbers(product.fit, left_out=product.left_out, noise=product.noise),
        "eigenvalues": eigenvalues(product.fit),
        "surface": _surface(product),
        "solid": solid_numbers(product, checks.step),
        "mesh": mesh_numbers(product, checks.stl),
        "deviation": _deviation(product.deviation),
        **_scan(product),
        "files": [file_entry(kind, path) for kind, path in files.items()],
        **_tail(product.seconds),
    }


def fit_report(
    fit: BladeFit,
    settings: Asked,
    *,
    name: str,
    sections: Sections,
    misprints: Sequence[Misprint],
    reason: str,
) -> Report:
    """Return the report on a fit alone, where no solid was asked for or none came about.

    `reason` says why the fit falls short; empty where it does not.
    """
    return {
        **_head(name, not reason, settings, (reason,) if reason else ()),
        "input": input_numbers(sections, fit.lines.notes),
        "misprints": [_misprint(one) for one in misprints],
        "fit": fit_numbers(fit),
        "eigenvalues": eigenvalues(fit),
        "files": [],
        **_tail({}),
    }


def input_numbers(sections: Sections, notes: tuple[str, ...]) -> Report:
    """Return what was read, with hashes of the file and of the points as they were used."""
    source = sections.source
    points = hashlib.sha256(b"".join(s.points.tobytes() for s in sections.sections))
    return {
        "file": source.path.name if source.path else None,
        "sha256": sha256(source.path) if source.path and source.path.is_file() else None,
        "points_sha256": points.hexdigest(),
        "format": source.format,
        "unit": source.unit,
        "unit_from": source.unit_from,
        "axis": source.axis,
        "axis_from": source.axis_from,
        "sections": [{"name": s.name, "points": len(s.points)} for s in sections.sections],
        "notes": [*source.notes, *notes],
    }


def sha256(path: Path) -> str:
    """Return the SHA-256 of a file, as `sha256sum` prints it."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _head(name: str, within: bool, settings: Any, reasons: tuple[str, ...]) -> Report:
    return {
        "schema": SCHEMA,
        "name": name,
        "verdict": {
            "within": within,
            "tolerance_mm": settings.tolerance,
            "reasons": list(reasons),
        },
        "settings": asdict(settings),
    }


def _tail(seconds: Mapping[str, float]) -> Report:
    return {
        "seconds": {step: round(s, 3) for step, s in seconds.items()},
        "versions": versions(PACKAGES),
    }


def versions(packages: Sequence[str]) -> dict[str, str | None]:
    """Return the versions of packages, of Python, and the platform."""
    found = {package: _version(package) for package in packages}
    return {**found, "python": platform.python_version(), "platform": sys.platform}


def _version(package: str) -> str | None:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return None


def _misprint(one: Misprint) -> Report:
    return {
        "section": one.section,
        "point": one.index + 1,
        "offset_mm": one.offset,
        "neighbours_agree_within_mm": one.scale,
    }


def _surface(product: Product) -> Report:
    surface, names = product.surface, product.lines.names
    left_out = between_sections(product)
    known = np.isfinite(left_out)
    return {
        "law": surface.law,
        "leading_edge": surface.le,
        "trailing_edge": surface.te,
        "span": product.lines.span,
        "section_left_out": [
            {"section": name, "max_mm": away} for name, away in zip(names, left_out, strict=True)
        ],
        "section_left_out_mm": left_out[known].max() if known.any() else None,
    }


def _scan(product: Product) -> Report:
    if product.scanned is None:
        return {}
    from bladecad.export.reports.report_scan import scan_numbers

    return {"scan": scan_numbers(product.scanned)}


def _deviation(deviation: Deviation) -> Report:
    section, point = deviation.worst()
    return {
        "positive": "outside the nominal surface",
        "largest_mm": deviation.largest,
        "worst": {"section": section, "point": point + 1},
        "set_aside": int(deviation.set_aside.sum()),
        "table": [row_numbers(row) for row in deviation.table()],
        "referee": {
            "by": "trimesh.proximity",
            "points": deviation.referee.count,
            "disagreement_mm": deviation.referee.disagreement,
            "bound_mm": deviation.referee.bound,
        },
    }


def file_entry(kind: str, path: Path) -> Report:
    """Return size and SHA-256 of a file that was written."""
    return {"is": kind, "file": path.name, "bytes": path.stat().st_size, "sha256": sha256(path)}
