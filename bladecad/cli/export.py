"""`bladecad export`: a blade in, one file for CAD or CAM out, as it is or as it is to be cut."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Literal, TypeAlias, cast

import typer

from bladecad.cli import export_options as want
from bladecad.cli import options as ask
from bladecad.cli.console import log_to_stderr, progress
from bladecad.cli.export_summary import cad_lines
from bladecad.cli.guard import Exit, guarded

if TYPE_CHECKING:
    from bladecad.pipeline.blade_file import BladeFile
    from bladecad.pipeline.cad import CadSettings

STL_TOLERANCE = 0.005  # mm, as in a build
Schema: TypeAlias = Literal["AP242DIS", "AP214IS"]
SCHEMAS: dict[str, Schema] = {"ap242": "AP242DIS", "ap214": "AP214IS"}


@guarded
def export(
    path: ask.Blade,
    output: want.OutputFile,
    faces: want.Faces = None,
    schema: want.Schema = None,
    tolerance: want.Tolerance = None,
    untwist: want.Untwist = None,
    scale: want.Scale = 1.0,
    shrinkage: want.Shrinkage = 0.0,
    mirror: want.Mirror = None,
    offset: want.Offset = 0.0,
    units: ask.Units = None,
    axis: ask.Axis = None,
    fit_tolerance: ask.FitTolerance = 0.01,
    name: ask.Name = None,
    force: ask.Force = False,
    quiet: ask.Quiet = False,
    verbose: ask.Verbose = False,
) -> Exit:
    """Write a blade as STEP, IGES, BREP or STL, in mm, read it back, and tell what was read.

    One solid; faces SUCTION_SIDE, PRESSURE_SIDE, HUB, TIP, and with --faces 4 LEADING_EDGE and
    TRAILING_EDGE. Every joint of the sides is measured: gap, angle (G1), jump of curvature (G2).
    """
    log_to_stderr(verbose)
    from bladecad.cam.variant import Variant, shrunk
    from bladecad.export.stage import check_file
    from bladecad.pipeline.cad import CadSettings

    _check_format(output, faces=faces, schema=schema, offset=offset)
    check_file(output, force=force)
    variant = Variant(mirror, scale * shrunk(shrinkage), 0.0 if untwist is None else untwist)
    divided = cast("Literal[1, 2, 4]", int(faces or 2))
    usual = STL_TOLERANCE if output.suffix.lower() == ".stl" else CadSettings.tolerance
    asked = usual if tolerance is None else tolerance
    settings = CadSettings(divided, asked, variant, offset)
    with progress(quiet=quiet) as tell:
        from bladecad.pipeline import Settings
        from bladecad.pipeline.blade_file import load_blade

        blade = load_blade(path, Settings(fit_tolerance, unit=units, axis=axis), progress=tell)
        if output.suffix.lower() == ".stl":
            lines, within = _stl(blade, settings, output, tell)
        else:
            lines, within = _cad(blade, settings, output, name, SCHEMAS[schema or "ap242"], tell)
    notes = [f"note: {note}" for note in blade.notes]
    for line in lines[-1:] if quiet else [*notes, *lines]:
        typer.echo(line)
    return Exit.WITHIN if within else Exit.OUT_OF_TOLERANCE


def _check_format(output: Path, *, faces: str | None, schema: str | None, offset: float) -> None:
    """Refuse an unknown suffix, and options that the format knows nothing of."""
    from bladecad.errors import ExportError
    from bladecad.export.cad.cad_suffix import cad_format

    stl = output.suffix.lower() == ".stl"
    if not stl and cad_format(output) != "STEP" and schema:
        raise ExportError(f"--schema is of STEP; {output.name} is {cad_format(output)}")
    asked = {"--faces": faces, "--schema": schema, "--offset": offset or None}
    refused = [option for option, value in asked.items() if value is not None]
    if stl and refused:
        raise ExportError(
            f"{' and '.join(refused)} cannot be had of {output.name}; write .step instead"
        )


def _cad(
    blade: BladeFile,
    settings: CadSettings,
    output: Path,
    name: str | None,
    schema: Schema,
    tell: Callable[[str], None],
) -> tuple[list[str], bool]:
    """Write STEP, IGES or BREP; return what to say, and whether it is within the tolerance."""
    from bladecad.pipeline.cad import cad_blade, export_cad

    made = cad_blade(blade.surface, settings, progress=tell)
    found = export_cad(made, output, name=name or blade.name, schema=schema, progress=tell)
    return list(cad_lines(made, found, output)), found.error <= settings.tolerance


def _stl(
    blade: BladeFile, settings: CadSettings, output: Path, tell: Callable[[str], None]
) -> tuple[list[str], bool]:
    """Write triangles; return what to say, and whether they are within the tolerance."""
    from bladecad.cam.variant import varied
    from bladecad.export.cad.stl import write_stl
    from bladecad.surface.triangulate import triangulate

    tell("triangles")
    mesh = triangulate(varied(blade.surface, settings.variant), chord_error=settings.tolerance)
    found = write_stl(mesh, output)
    line = (
        f"{output}: STL, {found.triangles} triangles, closed, volume {found.volume:.6g} mm3, "
        f"{1e3 * mesh.chord_error:.3g} um from the surface"
    )
    return [line], mesh.chord_error <= settings.tolerance
