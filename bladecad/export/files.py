"""All files of a blade: the solid, its triangles, the model, the report, the picture."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import asdict
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final

from bladecad.data.sections import Sections
from bladecad.errors import ExportError
from bladecad.export.cad.stl import write_stl
from bladecad.export.model.model_file import save
from bladecad.export.product import Product
from bladecad.export.reports.report import Checks, report, sha256
from bladecad.export.stage import REPORT, staged
from bladecad.export.text import write_json
from bladecad.fit.blade import BladeFit

DIGITS: Final = 9  # of the numbers in the report


def export_blade(
    product: Product,
    folder: str | os.PathLike[str],
    *,
    name: str | None = None,
    force: bool = False,
) -> dict[str, Path]:
    """Write all files of a blade, and read STEP and STL back before any of them is seen.

    Parameters
    ----------
    product : Product
        A finished blade, as `bladecad.build` returns it, within tolerance or not.
    folder : path
        New or empty; made where it is missing.
    name : str, optional
        Of the blade and its files; otherwise that of the file it was read from.
    force : bool
        Replace the files of an earlier blade in the folder.

    Returns
    -------
    dict
        "step", "stl", "model", "picture" and "report", and "scan" for its picture where the blade
        came from one, to their paths.

    Raises
    ------
    ExportError
        If the folder is in use or cannot be written, or if a file read back is not the blade;
        the folder is then as it was.
    """
    folder, name = Path(folder), name or name_of(product)
    if name == REPORT.removesuffix(".json"):
        raise ExportError(f'a blade called "{name}" would hide its own {REPORT}; give a --name')
    with staged(folder, force=force) as stage:
        files = {
            "step": stage / f"{name}.step",
            "stl": stage / f"{name}.stl",
            "model": stage / f"{name}.json",
            "picture": stage / "overview.png",
        }
        files |= {"scan": stage / "scan.png"} if product.scanned else {}
        checks = _write(product, files, name)
        write_json(
            report(product, name=name, checks=checks, files=files), stage / REPORT, digits=DIGITS
        )
    return {kind: folder / path.name for kind, path in (files | {"report": stage / REPORT}).items()}


def export_report(
    content: Mapping[str, Any], folder: str | os.PathLike[str], *, force: bool = False
) -> Path:
    """Write a report alone, where there is no blade to go with it."""
    with staged(folder, force=force) as stage:
        write_json(content, stage / REPORT, digits=DIGITS)
    return Path(folder) / REPORT


def name_of(product: Product) -> str:
    """Return the name of the file that the blade was read from, without its suffix."""
    path = product.sections.source.path
    return path.stem if path else "blade"


def provenance(sections: Sections, fit: BladeFit) -> dict[str, Any]:
    """Return what a model file tells of its origin."""
    source = sections.source
    return {
        "bladecad": version("bladecad"),
        "input": source.path.name if source.path else None,
        "sha256": sha256(source.path) if source.path and source.path.is_file() else None,
        "model": fit.model,
        "order": asdict(fit.order) if fit.order else None,
        "tolerance_mm": fit.tolerance,
        "max_mm": fit.errors.largest,
        "rms_mm": fit.errors.rms,
    }


def _write(product: Product, files: Mapping[str, Path], name: str) -> Checks:
    from bladecad.brep.confirm import confirm
    from bladecad.brep.reread import read_step
    from bladecad.export.cad.step import write_step
    from bladecad.export.pictures.picture import draw_overview

    write_step(product.solid, files["step"], name=name)
    agreement = confirm(product.solid, read_step(files["step"]))
    stl = write_stl(product.mesh, files["stl"])
    origin = provenance(product.sections, product.fit)
    machine = None if product.scanned else product.sections.machine  # a scan has its own frame
    save(product.surface, files["model"], provenance=origin, machine=machine)
    draw_overview(product, files["picture"], name=name)
    if product.scanned:
        from bladecad.export.pictures.scan_picture import draw_scan

        draw_scan(product.scanned, files["scan"], name=name)
    return Checks(agreement, stl)
