"""`bladecad info`: what a file holds, before anything is fitted to it."""

from __future__ import annotations

import typer

from bladecad.cli import options as ask
from bladecad.cli.console import log_to_stderr
from bladecad.cli.guard import Exit, guarded


@guarded
def info(
    path: ask.Input,
    units: ask.Units = None,
    axis: ask.Axis = None,
    le: ask.Lead = None,
    suction: ask.Suction = None,
    edges: ask.Edges = "file",
    as_json: ask.AsJson = False,
    verbose: ask.Verbose = False,
) -> Exit:
    """Tell what was read: format, units, edges, spacing, noise, and the numbers of each section."""
    log_to_stderr(verbose)
    from bladecad import pipeline
    from bladecad.export.reports.facts import as_dict
    from bladecad.export.reports.info import describe
    from bladecad.export.text import to_json

    settings = pipeline.Settings(unit=units, axis=axis, le=le, suction=suction, edges=edges)
    sections, found, keep = pipeline.load(path, settings)
    lines = pipeline.split(sections, settings, keep)
    if as_json:
        typer.echo(to_json(as_dict(sections, lines, misprints=found), digits=9))
    else:
        typer.echo(describe(sections, lines, misprints=found), nl=False)
    return Exit.WITHIN
