"""Triangles for gmsh: MSH 2.2, every patch a physical surface."""

from __future__ import annotations

import os
from collections.abc import Iterator

import numpy as np

from bladecad.meshes.named import NamedMesh
from bladecad.written import beside

TRIANGLE, SURFACE = 2, 2  # gmsh's element type, and dimension of a physical group


def write_msh(mesh: NamedMesh, path: str | os.PathLike[str]) -> None:
    """Write a mesh as gmsh's MSH 2.2, in mm, ASCII, every bit of the coordinates kept.

    2.2 is what other programs read too (gmshToFoam, FEniCS, meshio).

    Raises
    ------
    ExportError
        If the file cannot be written.
    """
    with beside(path) as part, part.open("w", encoding="ascii", newline="\n") as file:
        file.writelines(_lines(mesh))


def _lines(mesh: NamedMesh) -> Iterator[str]:
    yield "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    yield f"$PhysicalNames\n{len(mesh.patches)}\n"
    yield from (f'{SURFACE} {i} "{name}"\n' for i, name in enumerate(mesh.patches, 1))
    yield f"$EndPhysicalNames\n$Nodes\n{len(mesh.vertices)}\n"
    yield from (f"{i} {x!r} {y!r} {z!r}\n" for i, (x, y, z) in enumerate(mesh.vertices.tolist(), 1))
    yield f"$EndNodes\n$Elements\n{len(mesh.triangles)}\n"
    patch = np.repeat(np.arange(len(mesh.patches)) + 1, [len(k) for k in mesh.patches.values()])
    for i, (p, (a, b, c)) in enumerate(zip(patch, (mesh.triangles + 1).tolist(), strict=True), 1):
        yield f"{i} {TRIANGLE} 2 {p} {p} {a} {b} {c}\n"
    yield "$EndElements\n"
