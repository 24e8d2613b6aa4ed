"""One STL of several solids, a patch each, as OpenFOAM reads it: ASCII, in metres."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Final, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Points
from bladecad.cfd.fixed import Text, fixed, parsed, scaled
from bladecad.errors import ExportError
from bladecad.meshes.named import NamedMesh
from bladecad.surface.ruled import Triangles
from bladecad.written import beside

StlUnit: TypeAlias = Literal["m", "mm"]
PER_MM: Final[Mapping[StlUnit, float]] = {"m": 1e-3, "mm": 1.0}
DIGITS: Final[Mapping[StlUnit, int]] = {"m": 10, "mm": 7}  # after the point: 0.1 nm
OF_NORMALS: Final = 5
AT_ONCE: Final = 100_000
END: Final = b"endfacet\n"


def write_stl_solids(mesh: NamedMesh, path: str | os.PathLike[str], *, unit: StlUnit = "m") -> None:
    """Write every patch as a solid of its name, or nothing at all.

    Parameters
    ----------
    mesh : NamedMesh
        In mm, closed or not.
    path : path
        Replaced when it exists; written beside first, read back, and then renamed.
    unit : {"m", "mm"}
        OpenFOAM counts in metres.

    Raises
    ------
    ExportError
        If two vertices would be one as printed, if a name has a blank, if the file cannot be
        written, or what is read back is not the mesh.

    Notes
    -----
    Every vertex is printed once, to 0.1 nm, and copied wherever it is used: shared vertices are the
    same text, and the printed mesh is closed where the mesh is.
    """
    numbers = printed(mesh, unit)
    lines, shares = _vertex_lines(numbers, unit), _shares()
    with beside(path) as part:
        with part.open("wb") as file:
            for name, triangles in mesh.patches.items():
                file.write(f"solid {name}\n".encode())
                for block in _facets(mesh.vertices, triangles, lines, shares):
                    file.write(block.data)
                file.write(f"endsolid {name}\n".encode())
        _confirm(mesh, numbers, lines, part)


def printed(mesh: NamedMesh, unit: StlUnit) -> NDArray[np.int64]:
    """Vertices in units of the last digit that is printed, (n, 3).

    Raises
    ------
    ExportError
        If two of them are one, or a patch has a name that no file holds.
    """
    for name in mesh.patches:
        if not name or len(name.split()) != 1 or not name.isascii():
            raise ExportError(f'"{name}" is no name for a patch: letters, digits and _ only')
    numbers = scaled(mesh.vertices * PER_MM[unit], DIGITS[unit])
    distinct = len(np.unique(np.ascontiguousarray(numbers).view("V24")))
    if distinct < len(numbers):
        raise ExportError(
            f"{len(numbers) - distinct} vertices are less than 0.1 nm from another and would be "
            "one as printed; ask for larger triangles"
        )
    return numbers


def _facets(vertices: Points, triangles: Triangles, lines: Text, shares: Text) -> Iterator[Text]:
    """Records of one length, a facet each, some at a time."""
    for start in range(0, len(triangles), AT_ONCE):
        some = triangles[start : start + AT_ONCE]
        n = shares[scaled(_normals(vertices[some]), OF_NORMALS) + 10**OF_NORMALS]
        head = [_word("facet normal", n), *_spaced(n), _word("\nouter loop\n", n)]
        corners = [lines[some[:, i]] for i in range(3)]
        yield np.concatenate([*head, *corners, _word("endloop\nendfacet\n", n)], axis=1)


def _vertex_lines(numbers: NDArray[np.int64], unit: StlUnit) -> Text:
    """The line of every vertex, (n, w)."""
    text = fixed(numbers, DIGITS[unit])
    return np.concatenate([_word("vertex", text), *_spaced(text), _word("\n", text)], axis=1)


def _shares() -> Text:
    """All numbers from -1 to 1 that a normal is written with."""
    return fixed(np.arange(-(10**OF_NORMALS), 10**OF_NORMALS + 1), OF_NORMALS)


def _spaced(text: Text) -> list[Text]:
    """The three numbers of every row, a blank before each."""
    return [part for i in range(3) for part in (_word(" ", text), text[:, i])]


def _word(word: str, beside: Text) -> Text:
    return np.tile(np.frombuffer(word.encode(), np.uint8), (len(beside), 1))


def _normals(X: Array) -> Array:
    n = np.cross(X[:, 1] - X[:, 0], X[:, 2] - X[:, 0])
    return np.asarray(n / np.maximum(np.linalg.norm(n, axis=1, keepdims=True), 1e-300))


def read_stl_solids(path: str | os.PathLike[str]) -> dict[str, Text]:
    """Read what `write_stl_solids` wrote: the lines of the corners of every facet, (k, 3, w).

    Raises
    ------
    ExportError
        If the file has other records than those, or cannot be read.
    """
    try:
        data = Path(path).read_bytes()
    except OSError as error:
        raise ExportError(f"{path} cannot be read: {error.strerror}") from error
    found, at = {}, 0
    while at < len(data):
        line = data.index(b"\n", at)
        name = data[at:line].decode().removeprefix("solid ")
        last = data.find(f"endsolid {name}\n".encode(), line)
        if last < 0:
            raise ExportError(f'{path}: solid "{name}" does not end')
        found[name] = _corners(np.frombuffer(data, np.uint8, last - line - 1, line + 1))
        at = last + len(f"endsolid {name}\n")
    return found


def _corners(block: Text) -> Text:
    """The three lines of corners in records of one length."""
    record = bytes(block[:1000])
    length, first = record.find(END) + len(END), record.find(b"vertex")
    width = record.find(b"\n", first) + 1 - first
    records = block.reshape(-1, length)
    return records[:, first : first + 3 * width].reshape(-1, 3, width)


def places(lines: Text, unit: StlUnit = "m") -> Array:
    """Where corners are, (..., 3), mm, by the text of their lines, (..., w)."""
    text = lines[..., len("vertex") : -1]
    text = text.reshape(*text.shape[:-1], 3, -1)
    return np.asarray(parsed(text) / 10.0 ** DIGITS[unit] / PER_MM[unit])


def _confirm(mesh: NamedMesh, numbers: NDArray[np.int64], lines: Text, path: Path) -> None:
    """Raise unless every corner has the text of its vertex, and that text its number."""
    again = read_stl_solids(path)
    if list(again) != list(mesh.patches):
        raise ExportError(f"the STL read back has solids {list(again)}, not {list(mesh.patches)}")
    text = lines[:, len("vertex") : -1].reshape(len(lines), 3, -1)
    right = np.array_equal(parsed(text), numbers)
    for name, triangles in mesh.patches.items():
        right &= len(again[name]) == len(triangles)
        for start in range(0, len(triangles), AT_ONCE) if right else ():
            some = slice(start, start + AT_ONCE)
            right &= np.array_equal(again[name][some], lines[triangles[some]])
        if not right:
            raise ExportError(f'solid "{name}" of the STL read back is not the one written')
