"""`bladecad build`: sections in, a certified solid out."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, cast

from bladecad.cli import options as ask
from bladecad.cli import summary
from bladecad.cli.console import log_to_stderr, progress
from bladecad.cli.guard import Exit, guarded

if TYPE_CHECKING:
    from bladecad.errors import FitError
    from bladecad.fit.blade import BladeFit
    from bladecad.pipeline import Settings


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
    axis: ask.Axis = None,
    le: ask.Lead = None,
    suction: ask.Suction = None,
    edges: ask.Edges = "file",
    chord_error: ask.ChordError = 0.005,
    name: ask.Name = None,
    force: ask.Force = False,
    quiet: ask.Quiet = False,
    verbose: ask.Verbose = False,
) -> Exit:
    """Build a blade: sections in; STEP, STL, model, report and picture out.

    Out of tolerance the files are written all the same, and say so; where no fit meets the
    tolerance, the report alone is.
    """
    log_to_stderr(verbose)
    from bladecad import pipeline
    from bladecad.errors import FitError
    from bladecad.export.stage import check_folder

    settings = pipeline.Settings(
        tolerance, model, order, spectrum, law, units, axis, le, suction, edges, chord_error
    )
    check_folder(output, force=force)
    try:
        with progress(quiet=quiet) as tell:
            product = pipeline.build(path, settings, progress=tell)
            tell("files")
            from bladecad.export.files import export_blade

            written = export_blade(product, output, name=name, force=force)["report"]
    except FitError as error:
        written = _report_failure(error, path, settings, output, name, force)
    report = json.loads(written.read_text(encoding="utf-8"))
    summary.show(report, quiet=quiet, folder=written.parent)
    return Exit.WITHIN if report["verdict"]["within"] else Exit.OUT_OF_TOLERANCE


def _report_failure(
    error: FitError, path: Path, settings: Settings, output: Path, name: str | None, force: bool
) -> Path:
    """Write what the closest fit reaches, if there is one."""
    from bladecad import pipeline
    from bladecad.export.files import export_report
    from bladecad.export.report import fit_report

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
