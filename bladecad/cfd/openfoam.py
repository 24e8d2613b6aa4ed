"""A small OpenFOAM case, complete: the surface, its feature edges, and all dictionaries."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, TypeAlias, final

import numpy as np

from bladecad.arrays import Array, Vector
from bladecad.cfd.features import SHARP, features, write_emesh
from bladecad.cfd.foam import foam_header
from bladecad.cfd.inside import a_place_inside, winding
from bladecad.cfd.stl_solids import write_stl_solids
from bladecad.data.sections import Axis
from bladecad.errors import ExportError, GeometryError, ToleranceError
from bladecad.meshes.named import NamedMesh

MM: Final = 1e-3
Face: TypeAlias = tuple[int, int, int, int]
SIDES: Final[Mapping[Axis, tuple[Face, Face]]] = {  # of the box, low and high along x, y, z
    "x": ((0, 4, 7, 3), (1, 2, 6, 5)),
    "y": ((0, 1, 5, 4), (3, 7, 6, 2)),
    "z": ((0, 3, 2, 1), (4, 5, 6, 7)),
}
EDGES: Final = ("blade_le", "blade_te")
OPEN: Final = ("inlet", "outlet", "periodic_1", "periodic_2")
MOST_CELLS: Final = 2_000_000  # of the box before refinement
MOST_LEVELS: Final = 9


@final
@dataclass(frozen=True)
class Cells:
    """How large the cells of the volume mesh are, mm.

    surface : on the walls and openings of a passage; no larger, and no smaller than half of it
    blade   : on the sides, hub and tip of the blade
    edge    : on leading and trailing edge, and along the borders of all patches of the blade
    base    : of the box
    around  : how far the box of an outer flow reaches beyond the blade
    """

    surface: float
    blade: float
    edge: float
    base: float
    around: float

    def __post_init__(self) -> None:
        values = self.surface, self.blade, self.edge, self.base, self.around
        if not all(math.isfinite(x) and x > 0.0 for x in values):
            raise ToleranceError(f"cells of {values} mm are asked; all must be above 0")
        if self.level(self.edge) > MOST_LEVELS:
            raise ToleranceError(
                f"edge cells of {self.edge:g} mm in a box of {self.base:g} mm cells take "
                f"{self.level(self.edge)} refinements, {MOST_LEVELS} at most; ask for larger ones"
            )

    def level(self, cell: float) -> int:
        """Refinements of the box down to cells of that size or less."""
        return max(math.ceil(math.log2(self.base / cell) - 1e-9), 0)


def write_case(
    mesh: NamedMesh,
    folder: str | os.PathLike[str],
    cells: Cells,
    *,
    name: str = "blade",
    axis: Axis = "z",
    inside: Vector | None = None,
) -> None:
    """Write a case that OpenFOAM meshes as it is.

    surfaceFeatureExtract, blockMesh, snappyHexMesh -overwrite, checkMesh; Allrun does all four.

    Parameters
    ----------
    mesh : NamedMesh
        Closed, mm. With a patch "inlet" it bounds the flow, which is meshed inside; else the
        metal, and the flow is meshed round it, in a box.
    folder : path
        Exists; files are written into it, into constant/triSurface and system.
    cells : Cells
    name : str
        Of the STL and of the snapped surface.
    axis : {"x", "y", "z"}
        Along which the box has its inlet and outlet.
    inside : (3,) float, mm, optional
        A place in the flow, far from all patches; else one a little behind inlet or box.

    Raises
    ------
    ExportError
        If a file cannot be written.
    GeometryError
        If the mesh is not closed.
    """
    from jinja2 import Environment, PackageLoader, StrictUndefined

    if mesh.open_edges:
        raise GeometryError(f"the surface has {mesh.open_edges} open edges; a case needs it closed")
    folder = Path(folder)
    words = _words(mesh, cells, name, axis, inside)
    templates = Environment(
        loader=PackageLoader("bladecad.cfd", "case"), undefined=StrictUndefined,
        keep_trailing_newline=True, autoescape=False,
    )  # fmt: skip
    surface = folder / "constant" / "triSurface"
    try:
        surface.mkdir(parents=True, exist_ok=True)
        for file in templates.list_templates():
            target = folder / file
            target.parent.mkdir(exist_ok=True)
            target.write_text(templates.get_template(file).render(words), encoding="ascii")
        (folder / "Allrun").chmod(0o755)
    except OSError as error:
        raise ExportError(f"{folder} cannot be written: {error.strerror}") from error
    write_stl_solids(mesh, surface / f"{name}.stl")
    write_emesh(features(mesh), surface / f"{name}.eMesh")
    own = [patch for patch in mesh.patches if patch.startswith("blade_")]
    write_emesh(features(mesh, only=own), surface / f"{name}_blade.eMesh")


def _words(
    mesh: NamedMesh, cells: Cells, name: str, axis: Axis, inside: Vector | None
) -> Mapping[str, Any]:
    """What the templates say, in metres."""
    inner = "inlet" in mesh.patches
    low, counts = _box(mesh, cells, 0.0 if inner else cells.around)
    size = cells.base * counts
    smallest = MM * cells.base / 2 ** cells.level(cells.edge)
    place = inside
    if place is None:
        place = a_place_inside(mesh, 0.4 * cells.surface) if inner else low + 0.37 * cells.base
    third = cells.base / 2.0**MOST_LEVELS  # a third of the finest cell off is on no cell's face
    place = low + (np.floor((place - low) / third) + 1.0 / 3.0) * third
    if (abs(winding(mesh, place)) > 0.5) != inner:
        raise GeometryError("no place in the flow was found; ask for smaller cells")
    return {
        "header": lambda kind, file: foam_header(kind, file, "system"),
        "name": name,
        "sharp": SHARP,
        "base": MM * cells.base,
        "corners": MM * _corners(low, size),
        "cells": counts.tolist(),
        "box": _box_patches(axis, inner),
        "inside": MM * place,
        "patches": [_patch(patch, cells) for patch in mesh.patches],
        "feature_level": cells.level(cells.surface),
        "edge_level": cells.level(cells.edge),
        "least_volume": 1e-3 * smallest**3,
        "least_tet": 1e-9 * smallest,
    }


def _box(mesh: NamedMesh, cells: Cells, around: float) -> tuple[Vector, Array]:
    """Lowest corner and numbers of cubes; 1.31 of them beyond, so that no plane meets a cell's."""
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    margin = max(around, 1.31 * cells.base)
    counts = np.ceil((high - low + 2.0 * margin) / cells.base)
    if np.prod(counts) > MOST_CELLS:
        raise ToleranceError(
            f"a box of {cells.base:g} mm cells has {np.prod(counts):.3g} of them, {MOST_CELLS:,} "
            "at most; ask for a larger --size"
        )
    return 0.5 * (low + high - cells.base * counts), counts.astype(int)


def _corners(low: Vector, size: Vector) -> Array:
    """In the order of a hexahedron of OpenFOAM."""
    corner = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    return np.asarray(low + size * np.concatenate([corner, corner + np.array([0, 0, 1])]))


def _box_patches(axis: Axis, inner: bool) -> list[tuple[str, str, list[Face]]]:
    if inner:  # all of it is cut away
        return [("box", "patch", [face for pair in SIDES.values() for face in pair])]
    others = [face for other, pair in SIDES.items() if other != axis for face in pair]
    first, last = ([face] for face in SIDES[axis])
    return [("inlet", "patch", first), ("outlet", "patch", last), ("far", "patch", others)]


def _patch(name: str, cells: Cells) -> Mapping[str, Any]:
    on_blade = name.startswith("blade_")
    size = cells.edge if name in EDGES else cells.blade if on_blade else cells.surface
    kind = "patch" if name in OPEN else "wall"
    group = "blade" if on_blade else "openings" if name in OPEN else "endwalls"
    return {
        "name": name,
        "level": cells.level(size),
        "kind": kind,
        "group": group,
    }
