"""`bladecad convert`: sections from any format into any other."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from bladecad.cli import options as ask
from bladecad.cli.console import log_to_stderr
from bladecad.cli.guard import Exit, guarded


@guarded
def convert(
    path: ask.Input,
    output: Annotated[
        Path, typer.Argument(metavar="OUTPUT", help="File; its suffix says the format.")
    ],
    units: ask.Units = None,
    axis: ask.Axis = None,
    force: ask.Force = False,
    quiet: ask.Quiet = False,
    verbose: ask.Verbose = False,
) -> Exit:
    """Read sections in any format and write them in that of the suffix, in mm.

    .csv, .curve and .crv (TurboGrid), .geomTurbo (AutoGrid), .ibl, and points as .txt, .dat, .xyz
    or .pts.
    """
    log_to_stderr(verbose)
    from bladecad.data.read import read_sections
    from bladecad.data.write import write_sections
    from bladecad.export.stage import check_file

    check_file(output, force=force)
    sections = read_sections(path, unit=units, axis=axis)
    write_sections(sections, output)
    if not quiet:
        for note in sections.source.notes:
            typer.echo(f"note: {note}")
        typer.echo(f"{output}: {len(sections.sections)} sections, read as {sections.source.format}")
    return Exit.WITHIN
