"""The commands of `bladecad`, gathered."""

from __future__ import annotations

from typing import Annotated

import typer

from bladecad import __version__
from bladecad.cli.build import build
from bladecad.cli.cam_sheet import cam_sheet
from bladecad.cli.check import check
from bladecad.cli.convert import convert
from bladecad.cli.export import export
from bladecad.cli.fit import fit
from bladecad.cli.info import info
from bladecad.cli.mesh import mesh
from bladecad.cli.paper import paper
from bladecad.cli.sections import sections

CODES = "Exit codes: 0 done, within tolerance; 1 out of tolerance; 2 refused, nothing written."

app = typer.Typer(
    name="bladecad",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def main() -> None:
    """Run the command line."""
    app()


def _version(asked: bool) -> None:
    if asked:
        typer.echo(f"bladecad {__version__}")
        raise typer.Exit


@app.callback()
def common(
    _: Annotated[
        bool,
        typer.Option("--version", callback=_version, is_eager=True, help="Print the version."),
    ] = False,
) -> None:
    """Measured compressor blades to certified CAD."""


for command in (build, sections, check, export, cam_sheet, mesh, convert, fit, info, paper):
    app.command(epilog=CODES)(command)
