"""Scanned meshes, and clouds in mesh formats, through trimesh; told by content, not by suffix."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Points
from bladecad.data.scan_cut_off import HEAD, MeshFormat, refuse_cut_off, refuse_missing
from bladecad.data.scan_layout import Layout
from bladecad.data.scan_stl import read_text_stl
from bladecad.data.scan_unit import unit_said
from bladecad.data.sections import Unit
from bladecad.errors import DataError

SUFFIXES: dict[str, MeshFormat] = {".stl": "STL", ".ply": "PLY", ".obj": "OBJ", ".off": "OFF"}
STL_HEAD, STL_NAME, STL_FACET = 84, 80, 50  # bytes


def mesh_format(path: Path) -> MeshFormat | None:
    """Return the mesh format of a file, None if it is none.

    Raises
    ------
    DataError
        If a binary STL is shorter than it announces, or the suffix promises a mesh that the
        content is not.
    """
    with path.open("rb") as file:
        head = file.read(4096)
    start = head.lstrip().lower()
    if start.startswith((b"ply\n", b"ply\r")):
        return "PLY"
    if re.match(rb"(st|c|n|4)*off\b", start):
        return "OFF"
    if start.startswith(b"solid") and re.search(rb"\bfacet\b|\bendsolid\b", start):
        return "STL"
    if _is_binary_stl(path, head):
        return "STL"
    if b"\0" not in head and re.search(
        rb"^v\s+[-+.\d]\S*\s+[-+.\d]\S*\s+[-+.\d]", head, re.MULTILINE
    ):
        return "OBJ"
    promised = SUFFIXES.get(path.suffix.lower())
    if promised and (promised == "PLY" or b"\0" in head):
        raise DataError(
            f"{path.name} is no {promised}, whatever its suffix says; "
            "export the scan again as STL, PLY, OBJ, OFF or as points"
        )
    return None


def read_mesh(path: Path, form: MeshFormat) -> tuple[Points, NDArray[np.int64] | None]:
    """Return vertices in the order of the file, and triangles, None for a cloud.

    Raises
    ------
    DataError
        If it is cut off, trimesh cannot read it, or it holds no point.
    """
    import trimesh

    refuse_cut_off(path, form)
    quick = read_text_stl(path) if form == "STL" and _is_text(path) else None
    if quick:
        return quick
    try:
        with path.open("rb") as file:
            options = {"maintain_order": True, "skip_materials": True} if form == "OBJ" else {}
            loaded = trimesh.load(file, file_type=form.lower(), process=False, **options)
        points, triangles = _gathered(loaded)
    except Exception as error:
        raise DataError(
            f"{path.name} cannot be read as {form}: {error or type(error).__name__}; "
            "the file may be cut off: export the scan again"
        ) from error
    if not len(points):
        raise DataError(f"{path.name} holds no points; export the scan again")
    refuse_missing(path, form, points, triangles)
    return points, triangles


def cloud_layout(path: Path) -> Layout | None:
    """Return how the points of a PLY in text stand, None if it is binary or has faces."""
    with path.open("rb") as file:
        head, end, _ = file.read(HEAD).partition(b"end_header")
    first, *others = re.split(rb"^element\s+", head, flags=re.MULTILINE)[1:] or [b""]
    names = re.findall(r"^property\s+\w+\s+(\w+)\s*$", first.decode("latin-1"), re.MULTILINE)
    counts = [element.split()[1] for element in (first, *others) if element]
    empty = all(count == b"0" for count in counts[1:])
    if not (end and empty and b"format ascii" in head and b"\n" in head):
        return None
    if not first.startswith(b"vertex") or not {"x", "y", "z"} <= set(names):
        return None
    x, y, z = (names.index(name) for name in "xyz")
    unit = mesh_unit(path, "PLY")
    return Layout(head.count(b"\n") + 1, (x, y, z), len(names), unit, False, int(counts[0]))


def _is_text(path: Path) -> bool:
    with path.open("rb") as file:
        return b"\0" not in file.read(HEAD)


def mesh_unit(path: Path, form: MeshFormat) -> Unit | None:
    """Return the unit that a mesh names in its comments, None if it names none."""
    with path.open("rb") as file:
        lines = file.read(HEAD).decode("latin-1").splitlines()
    if form == "STL":
        return unit_said([lines[0][:STL_NAME]] if lines else [])
    if form == "PLY":
        head = (line for line in lines if line.startswith(("comment", "obj_info")))
        return unit_said(head)
    return unit_said(line for line in lines if line.startswith("#"))


def _gathered(loaded: Any) -> tuple[Points, NDArray[np.int64] | None]:
    """All parts of what trimesh read, one after the other."""
    parts = list(loaded.geometry.values()) if hasattr(loaded, "geometry") else [loaded]
    points = [np.asarray(part.vertices, dtype=np.float64).reshape(-1, 3) for part in parts]
    starts = np.cumsum([0, *map(len, points)])
    triangles = [
        np.asarray(part.faces, dtype=np.int64).reshape(-1, 3) + start
        for part, start in zip(parts, starts[:-1], strict=True)
        if getattr(part, "faces", None) is not None
    ]
    faces = np.concatenate(triangles) if triangles else np.empty((0, 3), np.int64)
    return np.concatenate(points) if points else np.empty((0, 3)), faces if len(faces) else None


def _is_binary_stl(path: Path, head: bytes) -> bool:
    """Whether the size is that of a binary STL with as many triangles as it announces."""
    if len(head) < STL_HEAD:
        return False
    size, count = path.stat().st_size, int.from_bytes(head[80:84], "little")
    if size == STL_HEAD + STL_FACET * count and count:
        return True
    if path.suffix.lower() == ".stl" and b"\0" in head:
        raise DataError(
            f"{path.name}: {count} triangles announced, which take {STL_HEAD + STL_FACET * count} "
            f"bytes, it has {size}; the file is cut off or damaged: export the scan again"
        )
    return False
