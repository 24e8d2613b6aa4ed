"""`bladecad fit`: sections in, the model file out, no solid."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, cast

from bladecad.cli import options as ask
from bladecad.cli import summary
from bladecad.cli.console import log_to_stderr, progress
from bladecad.cli.guard import Exit, guarded

if TYPE_CHECKING:
    from bladecad.curves.sides import BladeLines
    from bladecad.fit.blade import BladeFit
    from bladecad.pipeline import Settings


@guarded
def fit(
    path: ask.Input,
    output: ask.OutputModel,
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
    force: ask.Force = False,
    quiet: ask.Quiet = False,
    verbose: ask.Verbose = False,
) -> Exit:
    """Fit a blade by flows and write the model file; no solid is built, no point measured.

    With --order the model is written even where it falls short of the tolerance.
    """
    log_to_stderr(verbose)
    from bladecad import pipeline
    from bladecad.curves.outliers import noise
    from bladecad.export.files import provenance
    from bladecad.export.model.model_file import save
    from bladecad.export.reports.report import fit_report
    from bladecad.export.stage import check_file

    settings = pipeline.Settings(
        tolerance, model, order, spectrum, law, units, axis, le, suction, edges
    )
    check_file(output, force=force)
    with progress(quiet=quiet) as tell:
        sections, found, keep = pipeline.load(path, settings)
        lines = pipeline.split(sections, settings, keep)
        fitted, reason = _fitted(lines, settings, noise(sections), tell)
        if not reason or order is not None:
            surface = pipeline.surface_of(fitted, law)
            save(surface, output, provenance=provenance(sections, fitted), machine=sections.machine)
    content = fit_report(
        fitted, settings, name=path.stem, sections=sections, misprints=found, reason=reason
    )
    summary.show(content, quiet=quiet)
    return Exit.OUT_OF_TOLERANCE if reason else Exit.WITHIN


def _fitted(
    lines: BladeLines, settings: Settings, scatter: float, tell: Callable[[str], None]
) -> tuple[BladeFit, str]:
    """The fit, or the closest one, and why it is not good enough."""
    from bladecad import pipeline
    from bladecad.errors import FitError

    try:
        fitted = pipeline.fit(lines, settings, scatter, tell)
    except FitError as error:
        if error.best is None:
            raise
        return cast("BladeFit", error.best), str(error)
    return fitted, fitted.reason
