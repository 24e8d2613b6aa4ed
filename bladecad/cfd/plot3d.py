"""Structured blocks as Plot3D: multi-block, three-dimensional, formatted."""

from __future__ import annotations

import os
from collections.abc import Sequence

import numpy as np

from bladecad.arrays import Vector
from bladecad.meshes.blocks import Block
from bladecad.written import beside

A_LINE = 3  # numbers


def write_plot3d(blocks: Sequence[Block], path: str | os.PathLike[str]) -> None:
    """Write blocks as one formatted grid file (.xyz), in mm, every bit of the coordinates kept.

    The number of blocks; ni nj 1 of each; then of each all x, all y, all z, with i running fastest
    (Walatka and others, PLOT3D User's Manual, NASA TM 101067, 1990). No iblank.

    Raises
    ------
    ExportError
        If the file cannot be written.
    """
    with beside(path) as part, part.open("w", encoding="ascii", newline="\n") as file:
        file.write(f"{len(blocks)}\n")
        for block in blocks:
            nj, ni, _ = block.points.shape
            file.write(f"{ni} {nj} 1\n")
        for block in blocks:
            for x in np.moveaxis(block.points, 2, 0):
                file.write(_numbers(x.ravel()))


def _numbers(x: Vector) -> str:
    words = [repr(number) for number in x.tolist()]
    rows = (words[i : i + A_LINE] for i in range(0, len(words), A_LINE))
    return "".join(" ".join(row) + "\n" for row in rows)
