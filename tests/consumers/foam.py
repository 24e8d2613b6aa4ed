"""OpenFOAM's mesh as arrays, and its programs."""

from __future__ import annotations

import os
import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np

DEBIAN = Path("/usr/share/openfoam")
PROGRAMS = ("surfaceCheck", "surfaceFeatureExtract", "blockMesh", "snappyHexMesh", "checkMesh")


@dataclass(frozen=True)
class VolumeMesh:
    """Of OpenFOAM.

    points   : (n, 3) m
    faces    : point numbers of each
    owner    : cell of each face
    level    : how often the cell of the box that became each cell was halved
    boundary : patch to its faces
    """

    points: np.ndarray
    faces: list[np.ndarray]
    owner: np.ndarray
    level: np.ndarray
    boundary: dict[str, range]


def foam(*command: str, at: Path) -> str:
    """Run a program of OpenFOAM and return what it says."""
    environment = dict(os.environ)
    if DEBIAN.is_dir():
        environment.setdefault("WM_PROJECT_DIR", str(DEBIAN))
    run = subprocess.run(
        command, cwd=at, env=environment, capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stdout[-3000:] + run.stderr[-3000:]
    return run.stdout


def read_mesh(case: Path) -> VolumeMesh:
    folder = case / "constant" / "polyMesh"
    points = np.array(
        [row.split() for row in re.findall(r"\(([^()]+)\)", _body(folder / "points"))], float
    )
    faces = [
        np.array(row.split(), int)
        for row in re.findall(r"\d+\(([^()]+)\)", _body(folder / "faces"))
    ]
    boundary = {}
    text = (folder / "boundary").read_text()
    pattern = r"(\w+)\s*\{[^}]*nFaces\s+(\d+);\s*startFace\s+(\d+);"
    for name, count, start in re.findall(pattern, text):
        boundary[name] = range(int(start), int(start) + int(count))
    owner, level = (np.array(_body(folder / n).split(), int) for n in ("owner", "cellLevel"))
    return VolumeMesh(points, faces, owner, level, boundary)


def _body(path: Path) -> str:
    text = path.read_text()
    return text[text.index("\n(") + 2 : text.rindex(")")]


def patch_points(mesh: VolumeMesh, name: str, base: float) -> tuple[np.ndarray, np.ndarray]:
    """Points of a patch, mm, and the size of the smallest cell at each, mm.

    base : mm, edge of the cubes of the box
    """
    size = np.full(len(mesh.points), np.inf)
    for i in mesh.boundary[name]:
        np.minimum.at(size, mesh.faces[i], base / 2.0 ** mesh.level[mesh.owner[i]])
    used = np.flatnonzero(np.isfinite(size))
    return 1e3 * mesh.points[used], size[used]
