"""`bladecad cam-sheet`: a blade in, what its cutters must know out."""

from __future__ import annotations

from typing import Annotated

import typer

from bladecad.cli import options as ask
from bladecad.cli.console import log_to_stderr, progress
from bladecad.cli.guard import Exit, guarded

WIDTH = 14
CUT = "How it is cut"

Ball = Annotated[
    float,
    typer.Option("--ball", metavar="MM", rich_help_panel=CUT,
                 help="Radius of the ball cutter, and of a cylinder that would mill the flank."),
]  # fmt: skip
Scallop = Annotated[
    float,
    typer.Option("--scallop", metavar="MM", rich_help_panel=CUT,
                 help="Height of what may stand between two passes."),
]  # fmt: skip
Tolerance = Annotated[
    float,
    typer.Option("--tolerance", metavar="MM", rich_help_panel=CUT,
                 help="How far flank milling may be from the blade."),
]  # fmt: skip


@guarded
def cam_sheet(
    path: ask.Blade,
    output: ask.OutputFolder,
    ball: Ball = 3.0,
    scallop: Scallop = 0.005,
    tolerance: Tolerance = 0.05,
    fit_tolerance: ask.FitTolerance = 0.01,
    units: ask.Units = None,
    axis: ask.Axis = None,
    name: ask.Name = None,
    force: ask.Force = False,
    quiet: ask.Quiet = False,
    verbose: ask.Verbose = False,
) -> Exit:
    """Tell what a blade asks of its cutters: flank or point milling, radii, passes, stock.

    Writes cam.json, cam.csv and cam.png. The code is 0 whatever the verdict: a blade that wants a
    ball is no worse a blade.
    """
    log_to_stderr(verbose)
    from bladecad.cam.sheet import Cutting
    from bladecad.export.cad.cam_facts import cam_words
    from bladecad.export.stage import check_folder
    from bladecad.pipeline.blade_file import load_blade
    from bladecad.pipeline.build import Settings
    from bladecad.pipeline.cam import write_cam_sheet

    check_folder(output, force=force)
    cutting = Cutting(ball, scallop, tolerance)
    with progress(quiet=quiet) as tell:
        settings = Settings(tolerance=fit_tolerance, unit=units, axis=axis)
        blade = load_blade(path, settings, progress=tell)
        files, facts = write_cam_sheet(
            blade, cutting, output, name=name, force=force, progress=tell
        )
    if not quiet:
        for note in blade.notes:
            typer.echo(f"note: {note}")
        for head, text in cam_words(facts):
            typer.echo(f"{head:<{WIDTH}} {text}")
        for file in files.values():
            typer.echo(f"{'':<{WIDTH}} {file}")
    typer.echo(_verdict(facts["flank_milling"], tolerance))
    return Exit.WITHIN


def _verdict(found: dict[str, object], tolerance: float) -> str:
    word = "flank milling" if found["possible"] else "point milling"
    return (
        f"{word}: a cylinder along rulings would be {found['error_mm']:.3g} mm off, "
        f"{tolerance:.3g} mm are allowed"
    )
