"""Surface meshes as files: sized for the blade, written, read back, with a report beside."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final, Literal, TypeAlias

import numpy as np

from bladecad.arrays import Vector
from bladecad.cfd.openfoam import Cells, write_case
from bladecad.data.sections import Axis
from bladecad.export.stage import staged
from bladecad.export.text import write_json
from bladecad.meshes.blade import BladePatches, mesh_blade
from bladecad.meshes.curvature import largest_curvature
from bladecad.meshes.named import NamedMesh
from bladecad.meshes.quality import qualities
from bladecad.meshes.sizing import Sizing
from bladecad.pipeline.blade_file import BladeFile
from bladecad.pipeline.mesh_sizing import cells_for
from bladecad.surface.blade import BladeSurface
from bladecad.surface.loft import SIDES

Reached: TypeAlias = Mapping[str, Any]
MeshFormat: TypeAlias = Literal["openfoam", "stl", "msh", "plot3d", "vtk"]
REPORT: Final = "mesh.json"
DIGITS: Final = 9  # of its numbers


def write_blade_mesh(
    blade: BladeFile,
    folder: str | os.PathLike[str],
    form: MeshFormat,
    sizing: Sizing,
    *,
    force: bool = False,
) -> Mapping[str, Any]:
    """Mesh a blade, write it in one format with `mesh.json` beside, and return what that says.

    Parameters
    ----------
    blade : BladeFile
    folder : path
        New or empty, or given up by `force`; all files appear in it together, or none.
    form : {"openfoam", "stl", "msh", "plot3d", "vtk"}
        A complete case; one STL of several solids, in metres; gmsh's MSH; structured blocks;
        structured blocks and triangles for ParaView.
    sizing : Sizing
    force : bool

    Raises
    ------
    ExportError
        If the folder is in use or cannot be written.
    GeometryError, ToleranceError
        If the blade cannot be meshed as asked.
    """
    with staged(folder, force=force, report=REPORT) as stage:
        if form == "plot3d":
            mesh, reached = _write_plot3d(blade, stage, sizing)
        else:
            mesh, reached = _write_triangles(blade, stage, form, sizing)
        said = report(mesh, form, blade.name, sizing, reached, stage)
        write_json(said, stage / REPORT, digits=DIGITS)
    return said


def _write_triangles(
    blade: BladeFile, stage: Path, form: MeshFormat, sizing: Sizing
) -> tuple[NamedMesh, Reached]:
    cells = cells_for(blade.surface, sizing) if form == "openfoam" else None
    patches = mesh_blade(blade.surface, sizing)
    data = {}
    if form == "vtk":
        data = _point_data(blade.surface, patches)
        _write_vts(blade, stage, sizing)
    axis = blade.machine.axis
    write_mesh(patches.mesh, stage, form, blade.name, cells, axis=axis, point_data=data)
    return patches.mesh, {
        "chord_error_mm": patches.chord_error,
        "growth": patches.growth,
        "zones_t": patches.zones,
    }


def _write_plot3d(blade: BladeFile, stage: Path, sizing: Sizing) -> tuple[NamedMesh, Reached]:
    from bladecad.cfd.plot3d import write_plot3d
    from bladecad.meshes.blocks import blade_blocks, triangles_of

    found = blade_blocks(blade.surface, sizing)
    write_plot3d(found.blocks, stage / f"{blade.name}.xyz")
    return triangles_of(found.blocks), {
        "chord_error_mm": found.chord_error,
        "growth": found.growth,
        "blocks": {block.name: block.points.shape[1::-1] for block in found.blocks},
    }


def _write_vts(blade: BladeFile, stage: Path, sizing: Sizing) -> None:
    from bladecad.cfd.vtk import write_vts
    from bladecad.meshes.blocks import blade_blocks

    for block in blade_blocks(blade.surface, sizing).blocks:
        write_vts(block, stage / f"{blade.name}_{block.name.removeprefix('blade_')}.vts")


def write_mesh(
    mesh: NamedMesh,
    folder: Path,
    form: MeshFormat,
    name: str,
    cells: Cells | None,
    *,
    axis: Axis = "z",
    point_data: Mapping[str, Vector] | None = None,
    inside: Vector | None = None,
) -> None:
    """Write any named mesh, of a blade or of a passage, into a folder that exists."""
    if form == "openfoam":
        assert cells is not None
        write_case(mesh, folder, cells, name=_word(name), axis=axis, inside=inside)
    elif form == "stl":
        from bladecad.cfd.stl_solids import write_stl_solids

        write_stl_solids(mesh, folder / f"{name}.stl")
    elif form == "msh":
        from bladecad.cfd.msh import write_msh

        write_msh(mesh, folder / f"{name}.msh")
    elif form == "vtk":
        from bladecad.cfd.vtk import write_vtp

        write_vtp(mesh, folder / f"{name}.vtp", point_data or {})


def report(
    mesh: NamedMesh,
    form: MeshFormat,
    name: str,
    sizing: Sizing,
    reached: Reached,
    stage: Path,
) -> dict[str, Any]:
    """What `mesh.json` says: what was asked and reached, every patch, every file."""
    files = sorted(file for file in stage.rglob("*") if file.is_file())
    return {
        "schema": "bladecad-mesh/1",
        "name": name,
        "format": form,
        "asked": {
            "size_mm": sizing.size, "chord_error_mm": sizing.chord_error,
            "growth": sizing.growth, "edge_mm": sizing.edge,
        },
        "reached": dict(reached),
        "triangles": len(mesh.triangles),
        "open_edges": mesh.open_edges,
        "volume_mm3": mesh.volume,
        "patches": {patch: asdict(found) for patch, found in qualities(mesh).items()},
        "files": [
            {"file": file.relative_to(stage).as_posix(), "bytes": file.stat().st_size}
            for file in files
        ],
    }  # fmt: skip


def _point_data(surface: BladeSurface, patches: BladePatches) -> dict[str, Vector]:
    """u, t and curvature of every vertex; 0 on the rulings of hub, tip and blunt edges."""
    bend = np.zeros(len(patches.u))
    for side, s in zip(SIDES, (0.0, 1.0), strict=True):
        on = patches.s == s
        bend[on] = largest_curvature(surface, side, patches.u[on], patches.t[on])
    return {"u": patches.u, "t": patches.t, "curvature": bend}


def _word(name: str) -> str:
    """A name that OpenFOAM takes for a word."""
    kept = "".join(c if c.isascii() and c.isalnum() else "_" for c in name)
    return kept if kept[:1].isalpha() else f"blade_{kept}"
