"""Feature edges: where patches meet and where a surface is sharp, as OpenFOAM's `.eMesh`."""

from __future__ import annotations

import os
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path
from typing import Final, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Mask, Points, seal
from bladecad.cfd.foam import foam_header
from bladecad.cfd.stl_solids import DIGITS, PER_MM, StlUnit
from bladecad.meshes.named import NamedMesh
from bladecad.written import beside

SHARP: Final = 30.0  # degrees between normals: OpenFOAM's includedAngle of 150
Pairs: TypeAlias = NDArray[np.int64]  # (k, 2)


@final
@dataclass(frozen=True, eq=False)
class Features:
    """Edges of a mesh that a volume mesh should follow.

    points  : (n, 3) float, mm, those that edges use
    edges   : (k, 2) int, into points
    between : (k,) bool, whether two patches meet there; else the surface is sharp, or ends
    """

    points: Points
    edges: Pairs
    between: Mask

    def __post_init__(self) -> None:
        seal(self, points=(None, 3))


def features(
    mesh: NamedMesh, *, sharp: float = SHARP, only: Collection[str] | None = None
) -> Features:
    """Find the edges where patches meet, where triangles turn by more than `sharp` degrees, or end.

    The same that `surfaceFeatureExtract` finds with an includedAngle of 180 - sharp. With `only`,
    no more than those on the border of patches so named.
    """
    edges, first, second = _edges(mesh)
    patch = np.repeat(np.arange(len(mesh.patches)), [len(k) for k in mesh.patches.values()])
    n = _normals(mesh)
    between = (second >= 0) & (patch[first] != patch[second])
    turned = np.einsum("kx,kx->k", n[first], n[second]) < np.cos(np.radians(sharp))
    found = between | turned | (second < 0)
    if only is not None:
        named = np.array([name in only for name in mesh.patches])
        found &= between & (named[patch[first]] | named[patch[second]])
    used, numbers = np.unique(edges[found], return_inverse=True)
    return Features(mesh.vertices[used], numbers.reshape(-1, 2), between[found])


def _edges(mesh: NamedMesh) -> tuple[Pairs, NDArray[np.int64], NDArray[np.int64]]:
    """All edges, a triangle of each, and its other one, -1 where there is none."""
    k = mesh.triangles
    ends = np.sort(np.concatenate([k[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
    owner = np.tile(np.arange(len(k)), 3)
    keys = ends[:, 0] * len(mesh.vertices) + ends[:, 1]
    order = np.argsort(keys, kind="stable")
    _, start, count = np.unique(keys[order], return_index=True, return_counts=True)
    other = np.where(count > 1, owner[order[np.minimum(start + 1, len(order) - 1)]], -1)
    return ends[order[start]], owner[order[start]], other


def _normals(mesh: NamedMesh) -> Array:
    X = mesh.vertices[mesh.triangles]
    n = np.cross(X[:, 1] - X[:, 0], X[:, 2] - X[:, 0])
    return np.asarray(n / np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-300))


def write_emesh(found: Features, path: str | os.PathLike[str], *, unit: StlUnit = "m") -> None:
    """Write feature edges as OpenFOAM's featureEdgeMesh, points as the STL has them.

    Raises
    ------
    ExportError
        If the file cannot be written.
    """
    points = _rows(found.points * PER_MM[unit], f"%.{DIGITS[unit]}f")
    text = foam_header("featureEdgeMesh", Path(path).name, "constant/triSurface")
    text += f"\n{len(found.points)}\n(\n{points}\n)\n\n"
    text += f"{len(found.edges)}\n(\n{_rows(found.edges, '%d')}\n)\n"
    with beside(path) as part:
        part.write_text(text, encoding="ascii")


def _rows(table: Array | Pairs, each: str) -> str:
    row = "(" + " ".join([each] * table.shape[1]) + ")"
    return "\n".join(row % tuple(values) for values in table.tolist())
