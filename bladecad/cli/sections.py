"""`bladecad sections`: a scan in, its sections out, ordered and ready for any other program."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from bladecad.cli import options as ask
from bladecad.cli.console import log_to_stderr, progress
from bladecad.cli.guard import Exit, guarded
from bladecad.cli.which import scan_settings


@guarded
def sections(
    path: Annotated[Path, typer.Argument(metavar="SCAN", help="Mesh or cloud of points.")],
    output: Annotated[
        Path,
        typer.Option(
            "-o",
            "--output",
            metavar="FILE",
            help="File; its suffix says the format.",
            rich_help_panel=ask.OUT,
        ),
    ],
    stations: ask.Stations = None,
    units: ask.Units = None,
    axis: ask.ScanAxis = None,
    span: ask.Span = None,
    about: ask.About = None,
    cone: ask.Cone = None,
    le: ask.Lead = None,
    suction: ask.Suction = None,
    allow_partial: ask.AllowPartial = False,
    force: ask.Force = False,
    quiet: ask.Quiet = False,
    verbose: ask.Verbose = False,
) -> Exit:
    """Cut a scan into sections, hub to tip, and write them in the format of the suffix, in mm.

    .csv, .curve and .crv (TurboGrid), .geomTurbo (AutoGrid), .ibl (Creo), .sldcrv (SolidWorks), and
    points as .txt, .dat, .xyz or .pts. The points are smoothed: they lie on the sections, not where
    the scanner saw them.
    """
    log_to_stderr(verbose)
    from bladecad.data.write import check_suffix, write_sections
    from bladecad.export.stage import check_file
    from bladecad.pipeline.scan import sections_of_scan

    check_file(output, force=force)
    check_suffix(output)
    settings = scan_settings(
        unit=units, axis=axis, span=span, about=about, cone=cone, le=le, suction=suction,
        stations=stations, allow_partial=allow_partial,
    )  # fmt: skip
    with progress(quiet=quiet) as tell:
        found = sections_of_scan(path, settings, progress=tell)
        write_sections(found, output, force=force)
    if not quiet:
        for note in found.source.notes:
            typer.echo(f"note: {note}")
        points = sum(len(section.points) for section in found.sections)
        typer.echo(f"{output}: {len(found.sections)} sections, {points} points")
    return Exit.WITHIN
