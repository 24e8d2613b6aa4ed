"""`bladecad convert`: sections from any format into any other, or cut from the blade itself."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias

import typer

from bladecad.cli import options as ask
from bladecad.cli.console import log_to_stderr, progress
from bladecad.cli.guard import Exit, guarded

if TYPE_CHECKING:
    from bladecad.pipeline.sections_of import CutBlade

OnChoice: TypeAlias = Literal["planes", "cylinders", "streams"]

CUT = "Sections cut from the blade"


def parse_stations(text: str) -> Any:
    """Turn "11" into a count and "0.1,0.5,0.9" into places."""
    try:
        return int(text)
    except ValueError:
        return ask.parse_numbers(text)


Model = Annotated[
    Path,
    typer.Argument(metavar="MODEL", help="Sections in any format, or a model file to cut."),
]
Output = Annotated[Path, typer.Argument(metavar="OUTPUT", help="File; its suffix says the format.")]
Stations = Annotated[
    Any,
    typer.Option("--stations", parser=parse_stations, metavar="N|a,b,...", show_default=False,
                 help="How many sections, or where: heights or radii, mm; u on streams.",
                 rich_help_panel=CUT),
]  # fmt: skip
Points = Annotated[
    int | None,
    typer.Option("--points", metavar="N", help="Of a section, all round; else 240.",
                 show_default=False, rich_help_panel=CUT),
]  # fmt: skip
On = Annotated[
    OnChoice | None,
    typer.Option("--on", help="Planes square to the stacking axis, cylinders about the machine "
                 "axis, or the stream surfaces of the input; else streams.",
                 show_default=False, rich_help_panel=CUT),
]  # fmt: skip
SpanAxis = Annotated[
    Any,
    typer.Option("--span-axis", parser=ask.parse_direction, metavar="x|y|z|a,b,c",
                 help="Direction that planes are square to; else found.",
                 show_default=False, rich_help_panel=CUT),
]  # fmt: skip


@guarded
def convert(
    path: Model,
    output: Output,
    stations: Stations = None,
    points: Points = None,
    on: On = None,
    span_axis: SpanAxis = None,
    tolerance: ask.Tolerance = 0.01,
    units: ask.Units = None,
    axis: ask.Axis = None,
    le: ask.Lead = None,
    suction: ask.Suction = None,
    force: ask.Force = False,
    quiet: ask.Quiet = False,
    verbose: ask.Verbose = False,
) -> Exit:
    """Write sections in the format of the suffix, in mm.

    .csv, .curve and .crv (TurboGrid), .geomTurbo (AutoGrid), .ibl (Creo), .sldcrv (SolidWorks),
    .nom (PC-DMIS), and points as .txt, .dat, .xyz or .pts. The points of a file of sections stay
    as they are; with --stations, --points or --on, from a model file and for .nom they are cut
    from the surface instead, which is fitted to sections first.
    """
    log_to_stderr(verbose)
    from bladecad.data.write import check_suffix
    from bladecad.export.stage import check_file
    from bladecad.pipeline.blade_file import is_model

    check_file(output, force=force)
    check_suffix(output, normals=True)
    asked = {"stations": stations, "points": points, "on": on, "span_axis": span_axis}
    said = {option: value for option, value in asked.items() if value is not None}
    if not said and output.suffix.lower() != ".nom" and not is_model(path):
        _refuse_for_points(le=le, suction=suction)
        return _as_they_are(path, output, units, axis, force=force, quiet=quiet)
    from bladecad.pipeline.build import Settings

    settings = Settings(tolerance=tolerance, unit=units, axis=axis, le=le, suction=suction)
    return _cut(path, output, settings, said, force=force, quiet=quiet)


def _refuse_for_points(**asked: Any) -> None:
    """Refuse what would be passed over where points stay as they are."""
    from bladecad.errors import ToleranceError

    for option, value in asked.items():
        if value is not None:
            raise ToleranceError(
                f"--{option} {value} is for sections that are cut from the blade; give --on, "
                "--stations or --points too, or leave it out"
            )


def _as_they_are(
    path: Path, output: Path, units: Any, axis: Any, *, force: bool, quiet: bool
) -> Exit:
    from bladecad.data.read import read_sections
    from bladecad.data.write import write_sections

    sections = read_sections(path, unit=units, axis=axis)
    files = write_sections(sections, output, force=force)
    if not quiet:
        for note in sections.source.notes:
            typer.echo(f"note: {note}")
        count = len(sections.sections)
        typer.echo(f"{_named(files)}: {count} sections, read as {sections.source.format}")
    return Exit.WITHIN


def _cut(
    path: Path, output: Path, settings: Any, said: dict[str, Any], *, force: bool, quiet: bool
) -> Exit:
    from bladecad.pipeline.blade_file import load_blade
    from bladecad.pipeline.sections_of import CutSettings, sections_of
    from bladecad.pipeline.write_cut import write_cut

    cut = CutSettings(**said)
    with progress(quiet=quiet) as tell:
        blade = load_blade(path, settings, progress=tell)
        tell("cut")
        found = sections_of(blade, cut)
        tell("write")
        files = write_cut(found, output, force=force)
    if not quiet:
        for note in found.sections.source.notes:
            typer.echo(f"note: {note}")
        count, each = len(found.cuts), len(found.cuts[0].t)
        typer.echo(f"{_named(files)}: {count} sections of {each} points on {found.on}, read back")
        typer.echo(_errors(blade.error, found))
    return Exit.WITHIN


def _errors(fit: float, found: CutBlade) -> str:
    said = [f"the surface is {1e3 * fit:.2g} um from the sections that were read"] if fit else []
    if found.on != "streams":
        said += [f"all points lie within {found.error:.1g} mm on their {found.on}"]
    away = f"{1e3 * found.between:.2g} um"
    return "; ".join([*said, f"a cubic spline through them stays within {away} of the surface"])


def _named(files: tuple[Path, ...]) -> str:
    beside = [file.name for file in files[1:]]
    more = f"{beside[0]} to {beside[-1]}" if len(beside) > 3 else ", ".join(beside)
    return f"{files[0]}, with {more}" if beside else f"{files[0]}"
