"""The whole row: the passage of one blade turned round the axis, blade by blade."""

from __future__ import annotations

import numpy as np

from bladecad.errors import GeometryError
from bladecad.meshes.named import NamedMesh
from bladecad.passage.cylinder import turned
from bladecad.passage.domain import Passage

PERIODIC = ("periodic_1", "periodic_2")
LARGEST = 8_000_000  # triangles, some 2 GB as printed


def full_row(passage: Passage) -> NamedMesh:
    """Mesh of the fluid round all blades of the row, closed.

    Patches are those of the passage, all blades in one; what was periodic is gone: the copies
    share the vertices they met in.

    Raises
    ------
    GeometryError
        If that takes too many triangles.
    """
    asked = passage.count * len(passage.mesh.triangles)
    if asked > LARGEST:
        raise GeometryError(
            f"{passage.count} passages take {asked:,} triangles, {LARGEST:,} at most are made; ask "
            "for a larger size"
        )
    first, second = passage.twins.T
    X, count = passage.mesh.vertices, passage.count
    own = np.ones(len(X), dtype=bool)
    own[second] = False
    kept = [k for name, k in passage.mesh.patches.items() if name not in PERIODIC]
    used = np.zeros(len(X), dtype=bool)
    used[np.concatenate(kept)] = True
    place = np.cumsum(own & used) - 1
    size = int((own & used).sum())
    number = np.empty((count, len(X)), dtype=np.int64)
    for k in range(count):
        number[k] = place + k * size
        number[k, second] = place[first] + (k + 1) % count * size
    X = X[own & used]
    vertices = np.concatenate(
        [turned(X, passage.blade.axis, k * passage.pitch) for k in range(count)]
    )
    patches = {
        name: np.concatenate([number[k][triangles] for k in range(count)])
        for name, triangles in passage.mesh.patches.items()
        if name not in PERIODIC
    }
    return NamedMesh(vertices, patches)
