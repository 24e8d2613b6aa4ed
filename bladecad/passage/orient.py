"""Patches wound alike: each turned over until it meets its neighbours' edges the other way."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from bladecad.errors import GeometryError
from bladecad.meshes.named import NamedMesh
from bladecad.surface.ruled import Triangles


def coherent(mesh: NamedMesh) -> NamedMesh:
    """The same mesh, its patches wound alike and outwards.

    Raises
    ------
    GeometryError
        If a patch meets no other, or the mesh does not close.
    """
    n, waiting = len(mesh.vertices), dict(mesh.patches)
    name = next(iter(waiting))
    done: dict[str, Triangles] = {name: waiting.pop(name)}
    ahead = _directed(done[name], n)
    while waiting:
        name, sense = _next(waiting, ahead, n)
        done[name] = waiting.pop(name)[:, ::sense]
        ahead = np.concatenate([ahead, _directed(done[name], n)])
    found = NamedMesh(mesh.vertices, {name: done[name] for name in mesh.patches})
    if found.volume < 0.0:
        found = NamedMesh(mesh.vertices, {k: v[:, ::-1] for k, v in found.patches.items()})
    if found.open_edges:
        raise GeometryError(
            f"the mesh has {found.open_edges} open edges, 0 are allowed; ask for another size"
        )
    return found


def _next(waiting: Mapping[str, Triangles], ahead: Triangles, n: int) -> tuple[str, int]:
    """A patch that meets those done, and -1 where it must be turned over."""
    for name, triangles in waiting.items():
        forth = np.isin(_directed(triangles, n), ahead).sum()
        back = np.isin(_directed(triangles[:, ::-1], n), ahead).sum()
        if forth + back:
            return name, -1 if forth > back else 1
    raise GeometryError(f"the patches {', '.join(waiting)} meet no other patch")


def _directed(triangles: Triangles, n: int) -> Triangles:
    return np.concatenate([triangles[:, k] * n + triangles[:, (k + 1) % 3] for k in range(3)])
