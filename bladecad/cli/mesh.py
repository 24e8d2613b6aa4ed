"""`bladecad mesh`: a blade in, a surface mesh for CFD out, in named patches."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias

import typer

from bladecad.cli import options as ask
from bladecad.cli.console import log_to_stderr, progress
from bladecad.cli.guard import Exit, guarded

if TYPE_CHECKING:
    from bladecad.pipeline.blade_file import BladeFile

FormatChoice: TypeAlias = Literal["openfoam", "stl", "msh", "plot3d", "vtk"]
SIZES = "How large the triangles are"

Model = Annotated[
    Path, typer.Argument(metavar="MODEL", help="Model file, or sections that are fitted first.")
]
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
    float,
    typer.Option("--chord-error", metavar="MM", rich_help_panel=SIZES,
                 help="Largest distance of the triangles from the surface."),
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
    path: Model,
    output: ask.OutputFolder,
    format: Format,
    size: Size = None,
    chord_error: ChordError = 0.01,
    growth: Growth = 1.2,
    edge_size: EdgeSize = None,
    name: ask.Name = None,
    force: ask.Force = False,
    quiet: ask.Quiet = False,
    verbose: ask.Verbose = False,
) -> Exit:
    """Mesh a blade straight from its surface, closed, in named patches, as CFD programs take it.

    MODEL is a model file, or sections that are fitted as `build` does. mesh.json beside the mesh
    has the quality of every patch.
    """
    log_to_stderr(verbose)
    from bladecad.export.stage import check_folder
    from bladecad.pipeline.mesh import write_blade_mesh
    from bladecad.pipeline.mesh_sizing import sizing_for

    check_folder(output, force=force)
    with progress(quiet=quiet) as tell:
        blade = _blade(path, name, tell)
        sizing = sizing_for(
            blade.surface, size=size, chord_error=chord_error, growth=growth, edge=edge_size
        )
        tell("mesh")
        said = write_blade_mesh(blade, output, format, sizing, force=force)
    _show(said, blade, output, quiet=quiet)
    return Exit.WITHIN


def _blade(path: Path, name: str | None, tell: Any) -> BladeFile:
    """The blade, under the name that was asked for."""
    from dataclasses import replace

    from bladecad.pipeline.blade_file import load_blade

    blade = load_blade(path, progress=tell)
    return replace(blade, name=name) if name else blade


def _show(said: Mapping[str, Any], blade: BladeFile, output: Path, *, quiet: bool) -> None:
    if not quiet:
        for note in blade.notes:
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
    yield (
        f"{closed}; chord error {1e3 * reached['chord_error_mm']:.3g} um, "
        f"growth {reached['growth']:.3g}"
    )
