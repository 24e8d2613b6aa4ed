"""`bladecad mesh`: a blade in, a surface mesh for CFD out, in named patches."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias

import typer

from bladecad.cli import options as ask
from bladecad.cli import passage_options as asked
from bladecad.cli.console import log_to_stderr, progress
from bladecad.cli.guard import Exit, guarded

if TYPE_CHECKING:
    from bladecad.pipeline.blade_file import BladeFile
    from bladecad.pipeline.passage_settings import PassageSettings

FormatChoice: TypeAlias = Literal["openfoam", "stl", "msh", "plot3d", "vtk"]
SIZES = "How large the triangles are"

Format = Annotated[
    FormatChoice,
    typer.Option("--format", rich_help_panel=ask.OUT,
                 help="OpenFOAM case; STL in metres; gmsh; structured Plot3D; ParaView."),
]  # fmt: skip
Size = Annotated[
    float | None,
    typer.Option("--size", metavar="MM", show_default=False, rich_help_panel=SIZES,
                 help="Largest step along chord and span; else a fortieth of the chord."),
]  # fmt: skip
ChordError = Annotated[
    float | None,
    typer.Option("--chord-error", metavar="MM", show_default=False, rich_help_panel=SIZES,
                 help="Largest distance of the triangles from the surface; else 0.01, of a "
                 "passage a two hundredth of the size."),
]  # fmt: skip
Growth = Annotated[
    float,
    typer.Option("--growth", metavar="RATIO", rich_help_panel=SIZES,
                 help="Largest ratio of neighbouring steps along the chord."),
]  # fmt: skip
EdgeSize = Annotated[
    float | None,
    typer.Option("--edge-size", metavar="MM", show_default=False, rich_help_panel=SIZES,
                 help="Largest step at the edges; else as the chord error needs."),
]  # fmt: skip


@guarded
def mesh(
    path: ask.Blade,
    output: ask.OutputFolder,
    format: Format,
    size: Size = None,
    chord_error: ChordError = None,
    growth: Growth = 1.2,
    edge_size: EdgeSize = None,
    passage: asked.Passage = False,
    row: asked.Row = False,
    walls: asked.Walls = None,
    blades: asked.Blades = None,
    tip_gap: asked.TipGap = 0.0,
    hub_gap: asked.HubGap = 0.0,
    inlet: asked.Inlet = None,
    outlet: asked.Outlet = None,
    step: asked.Step = False,
    units: ask.Units = None,
    axis: ask.Axis = None,
    fit_tolerance: ask.FitTolerance = 0.01,
    name: ask.Name = None,
    force: ask.Force = False,
    quiet: ask.Quiet = False,
    verbose: ask.Verbose = False,
) -> Exit:
    """Mesh a blade straight from its surface, closed, in named patches, as CFD programs take it.

    With --passage the periodic flow domain round it, with --row that of the whole row. MODEL is a
    model file, or sections that are fitted as `build` does. mesh.json beside the mesh has the
    quality of every patch.
    """
    log_to_stderr(verbose)
    from bladecad.export.stage import check_folder
    from bladecad.pipeline import Settings
    from bladecad.pipeline.blade_file import load_blade

    domain = {
        "walls": walls, "blades": blades, "tip_gap": tip_gap, "hub_gap": hub_gap,
        "inlet": inlet, "outlet": outlet,
    }  # fmt: skip
    sizes = {"size": size, "chord_error": chord_error, "growth": growth, "edge": edge_size}
    settings = _settings({**domain, **sizes, "unit": units}) if passage or row else None
    if settings is None:
        asked.refuse_alone({**domain, "step": step})
    check_folder(output, force=force)
    with progress(quiet=quiet) as tell:
        blade = load_blade(path, Settings(fit_tolerance, unit=units, axis=axis), progress=tell)
        blade = replace(blade, name=name or blade.name)
        tell("mesh")
        notes = blade.notes
        if settings is None:
            said = _write_blade(blade, output, format, sizes, force)
        else:
            from bladecad.pipeline.passage import write_passage

            made, said = write_passage(
                blade, output, format, settings, row=row, step=step, force=force
            )
            notes += made.notes
    _show(said, notes, output, quiet=quiet)
    return Exit.WITHIN


def _settings(what: dict[str, Any]) -> PassageSettings:
    from bladecad.pipeline.passage_settings import PassageSettings

    return PassageSettings(**what)


def _write_blade(
    blade: BladeFile, output: Path, format: Any, sizes: dict[str, Any], force: bool
) -> Mapping[str, Any]:
    from bladecad.pipeline.mesh import write_blade_mesh
    from bladecad.pipeline.mesh_sizing import sizing_for

    if sizes["chord_error"] is None:
        sizes["chord_error"] = 0.01
    sizing = sizing_for(blade.surface, **sizes)
    return write_blade_mesh(blade, output, format, sizing, force=force)


def _show(said: Mapping[str, Any], notes: Sequence[str], output: Path, *, quiet: bool) -> None:
    if not quiet:
        for note in notes:
            typer.echo(f"note: {note}")
        for line in _table(said):
            typer.echo(line)
    typer.echo(f"{output}: {len(said['files'])} files, {said['triangles']} triangles")


def _table(said: Mapping[str, Any]) -> Iterator[str]:
    """A line for every patch."""
    yield f"{'patch':<16}{'triangles':>10}{'smallest angle':>16}{'skewness':>10}{'aspect':>8}"
    for name, found in said["patches"].items():
        yield (
            f"{name:<16}{found['triangles']:>10}{found['smallest_angle']:>12.1f} deg"
            f"{found['skewness']:>10.2f}{found['aspect']:>8.1f}"
        )
    reached = said["reached"]
    closed = "closed" if said["open_edges"] == 0 else f"{said['open_edges']} open edges"
    growth = f", growth {reached['growth']:.3g}" if "growth" in reached else ""
    yield f"{closed}; chord error {1e3 * reached['chord_error_mm']:.3g} um{growth}"
    if "blades" in reached:
        yield (
            f"volume {reached['volume_error']:.1e} (relative) off the quadrature, periodic faces "
            f"{reached['periodic_error_mm']:.1e} mm, blade ends {reached['trim_error_mm']:.1e} mm "
            f"off; {reached['clearance_mm']:.3g} mm from blade to periodic face"
        )
        if "solid_volume_error" in reached:
            yield (
                f"STEP solid: volume {reached['solid_volume_error']:.1e} (relative) off, edges "
                f"{1e3 * reached['edge_tolerance_mm']:.2g} um, {len(reached['faces'])} faces"
            )
