"""Compile the hot loops before they are needed: python -m bladecad.scans.compiled.

Numba keeps what it has compiled beside the source; without this the first build waits for it.
"""

from __future__ import annotations

import numpy as np

from bladecad.arrays import Array, Vector
from bladecad.deviation.nearest.skin import search, skin_of
from bladecad.deviation.nearest.squares import cut
from bladecad.deviation.nearest.triangles import search_triangles, triangle_skin
from bladecad.scans.fitting.local import Splines
from bladecad.scans.fitting.normal import accumulate


def compile_loops() -> None:
    """Run each of them once, on a quarter of a cylinder, a triangle and a few splines."""
    from bladecad.scans.fitting.kernels import blend

    x = np.linspace(0.0, 1.0, 5)
    search(skin_of(cut(_quarter, x, x, face=0, sign=1.0)), np.eye(3))
    search_triangles(triangle_skin(np.eye(3), np.array([[0, 1, 2]])), np.eye(3))
    splines = Splines.on(x)
    accumulate(splines, splines, x, x, np.ones((5, 3)), np.ones((5, 2)))
    poles = np.ones((splines.size, splines.size, 2))
    blend(*splines.four(x), *splines.four(x), poles, np.zeros((5, 2)))


def _quarter(u: Vector, t: Vector) -> Array:
    circle = np.column_stack([np.cos(t), np.sin(t)])
    return np.stack([np.column_stack([circle, np.full(len(t), height)]) for height in u])


if __name__ == "__main__":
    compile_loops()
