"""Meshes that end too soon: trimesh passes over what is not there."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Points
from bladecad.errors import DataError

MeshFormat = Literal["STL", "PLY", "OBJ", "OFF"]
HEAD: Final = 1 << 14  # bytes, of the head and of the end, that are looked at


def refuse_cut_off(path: Path, form: MeshFormat) -> None:
    """Refuse a text that ends within something; trimesh would pass over what it cannot read.

    Raises
    ------
    DataError
        If an STL does not end, or the last line of an OBJ or OFF is too short.
    """
    with path.open("rb") as file:
        head = file.read(HEAD)
        file.seek(-min(path.stat().st_size, HEAD), 2)
        end = file.read().rstrip().lower()
    if form == "PLY" or b"\0" in head:
        return
    last = end.rsplit(b"\n", 1)[-1].split()
    if form == "STL" and last and last[0] == b"endsolid":
        return
    if form != "STL" and len(last) >= _words_needed(last, form, head):
        return
    said = b" ".join(last)[:40].decode("latin-1")
    raise DataError(f'{path.name} ends with "{said}": it is cut off; export the scan again')


def _words_needed(last: list[bytes], form: MeshFormat, head: bytes) -> int:
    """Words that the last line of an OBJ or OFF needs: what it is, and three places or more."""
    if form == "OBJ":
        return 4 if last[0] in (b"f", b"v") else 0
    return int(last[0]) + 1 if _announced(form, head)[1] and last[0].isdigit() else 0


def _announced(form: MeshFormat, head: bytes) -> tuple[int, int]:
    """Vertices and faces that the head of a PLY or OFF announces, 0 where it does not."""
    if form == "OFF":
        counts = re.search(rb"^\s*(\d+)\s+(\d+)\s+\d+\s*$", head, re.MULTILINE)
        return (int(counts[1]), int(counts[2])) if counts else (0, 0)
    if form != "PLY":
        return 0, 0
    head = head.split(b"end_header")[0]
    found = dict(re.findall(rb"^element\s+(vertex|face)\s+(\d+)", head, re.MULTILINE))
    in_text = b"format ascii" in head  # binary ones are as long as they must be, or trimesh objects
    return int(found.get(b"vertex", 0)), int(found.get(b"face", 0)) if in_text else 0


def refuse_missing(
    path: Path, form: MeshFormat, points: Points, triangles: NDArray[np.int64] | None
) -> None:
    """Refuse a mesh that holds less than it announces."""
    with path.open("rb") as file:
        vertices, faces = _announced(form, file.read(HEAD))
    there = len(triangles) if triangles is not None else 0
    if len(points) < vertices or there < faces:
        raise DataError(
            f"{path.name}: {vertices} points and {faces} faces announced, {len(points)} and "
            f"{there} follow; the file is cut off: export the scan again"
        )
