"""The passage of a blade from its file: walls, blade count, trimming, mesh, files."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np

from bladecad.data.sections import Row
from bladecad.errors import DataError, ToleranceError
from bladecad.export.stage import staged
from bladecad.export.text import write_json
from bladecad.meshes.sizing import Sizing
from bladecad.passage.channel import channel_of, edges_on
from bladecad.passage.domain import Passage, mesh_passage
from bladecad.passage.read_walls import walls_of
from bladecad.passage.row import full_row
from bladecad.passage.trim import WALLS, Trimmed
from bladecad.passage.walls import turned_round, walls
from bladecad.pipeline.blade_file import BladeFile
from bladecad.pipeline.mesh import DIGITS, REPORT, MeshFormat, report, write_mesh
from bladecad.pipeline.mesh_sizing import cells_for
from bladecad.pipeline.passage_settings import PassageSettings

A_PITCH: Final = 10.0  # steps on the pitch at mid-span, where no size is asked
A_GAP: Final = 5.0  # chord errors at least in a gap
A_SIZE: Final = 200.0  # chord errors in a size, where none is asked


def passage_of(blade: BladeFile, settings: PassageSettings) -> Passage:
    """Mesh the periodic flow domain of a blade.

    Raises
    ------
    DataError
        If hub, shroud or blade count are not known, the hub is above the shroud, a wall ends
        before the blade, or the blade does not reach it within the limit.
    GeometryError
        If the blade crosses its periodic faces, or the mesh is not as asked.
    """
    row = _row(blade, settings)
    trimmed = trimmed_of(blade, row, settings)
    channel, notes = channel_of(trimmed, inlet=settings.inlet, outlet=settings.outlet)
    count = row.blade_count or 0
    sizing = _sizing(trimmed, count, settings)
    return mesh_passage(trimmed, channel, count, sizing, notes=notes)


def trimmed_of(blade: BladeFile, row: Row, settings: PassageSettings) -> Trimmed:
    """The blade between its walls, which are turned to run from leading to trailing edge."""
    hub, shroud = walls(row.hub, row.shroud)
    gaps = settings.hub_gap, settings.tip_gap
    column = blade.machine.column
    trimmed = Trimmed(blade.surface, column, hub, shroud, *gaps, settings.limit)
    pair = []
    for name in WALLS:
        le, te = edges_on(trimmed, name)
        wall = trimmed.wall(name)
        pair.append(wall if le < te else turned_round(wall))
    return Trimmed(blade.surface, column, pair[0], pair[1], *gaps, settings.limit)


def write_passage(
    blade: BladeFile,
    folder: str | os.PathLike[str],
    form: MeshFormat,
    settings: PassageSettings,
    *,
    row: bool = False,
    step: bool = False,
    force: bool = False,
) -> tuple[Passage, Mapping[str, Any]]:
    """Write the passage of a blade, or its whole row, with `mesh.json` beside; all or nothing.

    Parameters
    ----------
    blade, folder, form, force
        As `write_blade_mesh` takes them.
    settings : PassageSettings
    row : bool
        The mesh of all blades of the row.
    step : bool
        The passage of one blade as a STEP solid, too.

    Returns
    -------
    Passage, and what `mesh.json` says.

    Raises
    ------
    As `passage_of`; ExportError where the folder is in use or cannot be written.
    """
    if form == "plot3d":
        raise ToleranceError("a passage has no structured blocks; ask for another --format")
    with staged(folder, force=force, report=REPORT) as stage:
        passage = passage_of(blade, settings)
        mesh = full_row(passage) if row else passage.mesh
        name = f"{blade.name}_{'row' if row else 'passage'}"
        sizing = _sizing(passage.blade, passage.count, settings)
        cells = cells_for(blade.surface, sizing) if form == "openfoam" else None
        write_mesh(mesh, stage, form, name, cells, axis=blade.machine.axis, inside=passage.inside)
        found = reached(passage)
        if step:
            found |= _write_step(passage, stage, blade.name)
        said = report(mesh, form, name, sizing, found, stage)
        write_json(said, stage / REPORT, digits=DIGITS)
    return passage, said


def _write_step(passage: Passage, stage: Path, name: str) -> dict[str, Any]:
    from bladecad.export.cad.passage_step import write_passage_step
    from bladecad.passage.outlines import shape_of

    file = stage / f"{name}_passage.step"
    shape = shape_of(passage)
    solid = write_passage_step(shape, file, name=f"{name} passage")
    return {
        "solid_wall_error_mm": shape.wall_error,
        "solid_volume_error": solid.volume_error,
        "edge_tolerance_mm": solid.edge_tolerance,
        "faces": list(solid.faces),
    }


def reached(passage: Passage) -> dict[str, Any]:
    """The numbers of a passage, as `mesh.json` has them."""
    return {
        "blades": passage.count,
        "pitch_deg": float(np.degrees(passage.pitch)),
        "tip_gap_mm": passage.blade.tip_gap,
        "hub_gap_mm": passage.blade.hub_gap,
        "volume_by_quadrature_mm3": passage.volume,
        "volume_error": passage.volume_error,
        "periodic_error_mm": passage.period_error,
        "trim_error_mm": passage.trim_error,
        "chord_error_mm": passage.chord_error,
        "clearance_mm": passage.clearance,
        "inside_mm": passage.inside,
    }


def _row(blade: BladeFile, settings: PassageSettings) -> Row:
    """Walls and blade count: what is asked, else what the walls' file says, else the blade's."""
    own = blade.machine.row
    said = own
    if settings.walls is not None:
        said = walls_of(settings.walls, unit=settings.unit, axis=blade.machine.axis)
    elif not len(own.hub) or not len(own.shroud):
        raise DataError(
            f"{blade.name}: the file says nothing of hub and shroud; name one that does by --walls"
        )
    count = settings.blades or said.blade_count or own.blade_count
    if count is None:
        raise DataError(
            f"{blade.name}: the file does not say how many blades the row has; give --blades"
        )
    return Row(count, said.hub, said.shroud)


def _sizing(blade: Trimmed, count: int, settings: PassageSettings) -> Sizing:
    """What is asked; else a tenth of the pitch, and a two hundredth of that for the chord error.

    Triangles of the wall lie inside it: a chord error as large as a gap would close it.
    """
    size = settings.size
    if size is None:
        half = np.array([0.5])
        r = np.linalg.norm(np.delete(blade.surface("suction", half, half)[0, 0], blade.axis))
        size = float(2.0 * np.pi * r / count / A_PITCH)
    error = settings.chord_error if settings.chord_error is not None else size / A_SIZE
    gaps = [gap for gap in (blade.hub_gap, blade.tip_gap) if gap > 0.0]
    error = min([error, *(gap / A_GAP for gap in gaps)])
    return Sizing(size, error, settings.growth, settings.edge)
