"""`bladecad paper`: the paper's figures on a blade, and what each improvement buys."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from bladecad.cli import options as ask
from bladecad.cli.console import log_to_stderr, progress
from bladecad.cli.guard import Exit, guarded

Blade = Annotated[
    Path | None,
    typer.Argument(
        metavar="[INPUT]",
        help="File, folder, or one file of a numbered family \\[default: Rotor 37, laid out as the "
        "paper's, and the ladder on every blade at hand].",
        show_default=False,
    ),
]


@guarded
def paper(
    output: ask.OutputFolder,
    path: Blade = None,
    units: ask.Units = None,
    axis: ask.Axis = None,
    le: ask.Lead = None,
    suction: ask.Suction = None,
    edges: ask.Edges = "file",
    force: ask.Force = False,
    quiet: ask.Quiet = False,
    verbose: ask.Verbose = False,
) -> Exit:
    """Replay the paper: figures 1 to 5, the ladder of models, the homotopy and the origin.

    Every figure is written as PNG, SVG and CSV, and paper.md tells what they show.
    """
    log_to_stderr(verbose)
    from bladecad.export.stage import check_folder, staged
    from bladecad.pipeline import Settings
    from bladecad.replay.results import replayed
    from bladecad.replay.write import write, write_page

    check_folder(output, force=force)
    settings = Settings(unit=units, axis=axis, le=le, suction=suction, edges=edges)
    with progress(quiet=quiet) as tell:
        results = replayed(path, settings, progress=tell)
        with staged(output, force=force) as folder:
            write(results, folder, tell)
            write_page(results, folder / "paper.md")
    return Exit.WITHIN
