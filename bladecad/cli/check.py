"""`bladecad check`: a nominal and a scan in, a verdict out."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from bladecad.cli import check_summary
from bladecad.cli import options as ask
from bladecad.cli.console import log_to_stderr, progress
from bladecad.cli.guard import Exit, guarded

HOW = "How the scan is laid on the nominal"


def parse_tolerance(text: str) -> Any:
    """Turn "0.05" into a number, anything else into a path."""
    try:
        return float(text)
    except ValueError:
        return Path(text)


def parse_axis(text: str) -> Any:
    """Turn "x" or "1,0,0.1" into a direction."""
    found = ask.parse_direction(text)
    return tuple(float(found == name) for name in "xyz") if isinstance(found, str) else found


def parse_locked(text: str) -> Any:
    """Turn "x,rz" into the coordinates that are kept."""
    return tuple(word.strip() for word in text.split(",") if word.strip())


NominalFile = Annotated[
    Path, typer.Argument(metavar="NOMINAL", help="Model file, sections, STEP or mesh.")
]
ScanFile = Annotated[
    Path, typer.Argument(metavar="SCAN", help="Mesh, cloud of points, or sections.")
]
Tolerance = Annotated[
    Any,
    typer.Option("--tolerance", parser=parse_tolerance, metavar="FILE|MM",
                 help="Tolerance file (TOML), or the same +/- band for all zones, mm."),
]  # fmt: skip
Fit = Annotated[
    ask.FitChoice,
    typer.Option(help="Best fit from any pose, or the scan as it stands.", rich_help_panel=HOW),
]
Lock = Annotated[
    Any,
    typer.Option("--lock", parser=parse_locked, metavar="x,y,z,rx,ry,rz",
                 help="Coordinates that the best fit leaves alone.", show_default=False,
                 rich_help_panel=HOW),
]  # fmt: skip
ScanUnits = Annotated[
    ask.UnitChoice | None,
    typer.Option("--units", help="Unit of SCAN; else as it says, else mm.", show_default=False,
                 rich_help_panel=ask.READ),
]  # fmt: skip
NominalUnits = Annotated[
    ask.UnitChoice | None,
    typer.Option("--nominal-units", help="Unit of NOMINAL; else as it says, else mm.",
                 show_default=False, rich_help_panel=ask.READ),
]  # fmt: skip
NominalTolerance = Annotated[
    float,
    typer.Option("--nominal-tolerance", metavar="MM", rich_help_panel=ask.READ,
                 help="Of the fit, where NOMINAL is a file of sections, mm."),
]  # fmt: skip
SpanAxis = Annotated[
    Any,
    typer.Option("--span-axis", parser=parse_axis, metavar="x|y|z|a,b,c", show_default=False,
                 help="From hub to tip, of a STEP or mesh; else found.", rich_help_panel=ask.READ),
]  # fmt: skip
Stations = Annotated[
    Any,
    typer.Option("--stations", parser=ask.parse_numbers, metavar="u,u,...", show_default=False,
                 help="Span of the sections in the report, 0 .. 1; else those of NOMINAL.",
                 rich_help_panel=ask.OUT),
]  # fmt: skip
Partial = Annotated[
    bool, typer.Option("--partial", help="Judge a scan of one side.", rich_help_panel=HOW)
]
Csv = Annotated[bool, typer.Option("--csv", help="Write every point too.", rich_help_panel=ask.OUT)]
Png = Annotated[
    bool, typer.Option("--png", help="Write the pictures too.", rich_help_panel=ask.OUT)
]


@guarded
def check(
    nominal: NominalFile,
    scan: ScanFile,
    output: ask.OutputFolder,
    tolerance: Tolerance,
    fit: Fit = "best",
    lock: Lock = None,
    partial: Partial = False,
    units: ScanUnits = None,
    nominal_units: NominalUnits = None,
    nominal_tolerance: NominalTolerance = 0.01,
    axis: ask.Axis = None,
    le: ask.Lead = None,
    suction: ask.Suction = None,
    span_axis: SpanAxis = None,
    stations: Stations = None,
    csv: Csv = False,
    png: Png = False,
    name: ask.Name = None,
    force: ask.Force = False,
    quiet: ask.Quiet = False,
    verbose: ask.Verbose = False,
) -> Exit:
    """Check a scan against its nominal: how far every point is from the metal it should be.

    The report is written whatever the verdict.
    """
    log_to_stderr(verbose)
    from bladecad import pipeline
    from bladecad.export.stage import check_folder

    settings = pipeline.CheckSettings(
        fit=fit,
        locked=lock or (),
        unit=units,
        stations=stations,
        partial=partial,
        nominal=pipeline.NominalSettings(
            nominal_tolerance, nominal_units, axis, le, suction, span_axis
        ),
    )
    check_folder(output, force=force)
    with progress(quiet=quiet) as tell:
        found = pipeline.check(nominal, scan, tolerance, settings, name=name, progress=tell)
        tell("report")
        from bladecad.export.check.files import export_check

        files = export_check(found, output, csv=csv, png=png, force=force)
    check_summary.show(found, files, quiet=quiet)
    return Exit.WITHIN if found.within else Exit.OUT_OF_TOLERANCE
