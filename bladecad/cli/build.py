"""`bladecad build`: sections or a scan in, a certified solid out."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, cast

from bladecad.cli import options as ask
from bladecad.cli import summary
from bladecad.cli.console import log_to_stderr, progress
from bladecad.cli.guard import Exit, guarded
from bladecad.cli.which import refuse_for_scans, refuse_for_sections, scan_settings

if TYPE_CHECKING:
    from bladecad.errors import FitError
    from bladecad.fit.blade import BladeFit
    from bladecad.pipeline import Settings
    from bladecad.pipeline.scan_settings import ScanSettings


@guarded
def build(
    path: ask.Input,
    output: ask.OutputFolder,
    tolerance: ask.Tolerance = 0.01,
    model: ask.Model = "modal",
    order: ask.OrderOf = None,
    spectrum: ask.Spectrum = "shared",
    law: ask.Law = "spline",
    units: ask.Units = None,
    axis: ask.AnyAxis = None,
    le: ask.Lead = None,
    suction: ask.Suction = None,
    edges: ask.Edges = "file",
    span: ask.Span = None,
    about: ask.About = None,
    cone: ask.Cone = None,
    stations: ask.Stations = None,
    align: ask.Align = False,
    allow_partial: ask.AllowPartial = False,
    chord_error: ask.ChordError = 0.005,
    name: ask.Name = None,
    force: ask.Force = False,
    quiet: ask.Quiet = False,
    verbose: ask.Verbose = False,
) -> Exit:
    """Build a blade: sections or a scan in; STEP, STL, model, report and picture out.

    The content decides which it is. Out of tolerance the files are written all the same, and say
    so; where no fit meets the tolerance, the report alone is.
    """
    log_to_stderr(verbose)
    from bladecad.data.kind import kind_of
    from bladecad.export.stage import check_folder
    from bladecad.pipeline import Settings

    check_folder(output, force=force)
    settings: Settings | ScanSettings
    if kind_of(path) == "scan":
        refuse_for_scans(path, model=model, spectrum=spectrum, law=law, edges=edges)
        settings = scan_settings(
            tolerance=tolerance, order=order, unit=units, axis=axis, span=span, about=about,
            cone=cone, le=le, suction=suction, chord_error=chord_error, stations=stations,
            align=align, allow_partial=allow_partial,
        )  # fmt: skip
    else:
        refuse_for_sections(
            path, axis=axis, span=span, about=about, cone=cone, stations=stations, align=align,
            allow_partial=allow_partial,
        )  # fmt: skip
        settings = Settings(
            tolerance, model, order, spectrum, law, units, axis, le, suction, edges, chord_error
        )
    with progress(quiet=quiet) as tell:
        written = _written(path, settings, output, name, force, tell)
    report = json.loads(written.read_text(encoding="utf-8"))
    summary.show(report, quiet=quiet, folder=written.parent)
    return Exit.WITHIN if report["verdict"]["within"] else Exit.OUT_OF_TOLERANCE


def _written(
    path: Path,
    settings: Settings | ScanSettings,
    output: Path,
    name: str | None,
    force: bool,
    tell: Callable[[str], None],
) -> Path:
    """Build the blade and write its files; return the report."""
    from bladecad import pipeline
    from bladecad.errors import FitError
    from bladecad.export.product import Product
    from bladecad.pipeline.scan_settings import ScanSettings

    product: Product
    if isinstance(settings, ScanSettings):
        from bladecad.pipeline.scan import build_scan

        product = build_scan(path, settings, progress=tell)
    else:
        try:
            product = pipeline.build(path, settings, progress=tell)
        except FitError as error:
            return _report_failure(error, path, settings, output, name, force)
    tell("files")
    from bladecad.export.files import export_blade

    return export_blade(product, output, name=name, force=force)["report"]


def _report_failure(
    error: FitError, path: Path, settings: Settings, output: Path, name: str | None, force: bool
) -> Path:
    """Write what the closest fit reaches, if there is one."""
    from bladecad import pipeline
    from bladecad.export.files import export_report
    from bladecad.export.reports.report import fit_report

    if error.best is None:
        raise error
    sections, found, _ = pipeline.load(path, settings)
    content = fit_report(
        cast("BladeFit", error.best),
        settings,
        name=name or path.stem,
        sections=sections,
        misprints=found,
        reason=str(error),
    )
    return export_report(content, output, force=force)
