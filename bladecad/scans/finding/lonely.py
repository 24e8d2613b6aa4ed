"""Points that stand alone: neighbours much further away than theirs are from each other."""

from __future__ import annotations

from itertools import product
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from bladecad.arrays import Mask, Points

CELL: Final = 6.0  # times the usual spacing: thin cover of an edge, a ninth of the usual, holds on
SAMPLE: Final = 100_000  # points that the spacing is found from
SMALL: Final = 0.01  # of the points: islands with fewer are no part of the blade
PORE: Final = 3.0  # times the spacing: cells in which single points are looked for
FEW: Final = 2  # points of such a cell that are looked at one by one
NEIGHBOURS: Final = 4
FAR: Final = 4.0  # times the distance that is usual about the neighbours
FINEST: Final = 6_000  # spacings over the size, at most

Cells = NDArray[np.int64]
HALF: Final = [d for d in product((-1, 0, 1), repeat=3) if d > (0, 0, 0)]


def spacing(points: Points) -> float:
    """Usual distance of neighbours on the surface, mm: by how many cells they fill."""
    some = points[:: max(len(points) // SAMPLE, 1)]
    size = float(np.linalg.norm(np.ptp(np.quantile(some, (0.01, 0.99), axis=0), axis=0)))
    edge = size / 50.0
    keys, _ = _cells(some, edge)
    return float(edge * np.sqrt(len(np.unique(keys)) / 1.5 / len(points)))


def lonely(points: Points) -> tuple[Mask, Cells]:
    """Find the isolated points of a cloud.

    Returns
    -------
    lonely : (k,) bool
        Points on islands of cells that touch no others and hold few points, and single points
        whose neighbours are four times further away than is usual for these.
    island : (k,) int
        Number of the island of every point, the one with most points 0.
    """
    size = float(np.linalg.norm(np.ptp(points, axis=0)))
    usual = max(spacing(points), size / FINEST)
    keys, strides = _cells(points, CELL * usual)
    cells, number, count = np.unique(keys, return_inverse=True, return_counts=True)
    island, held = _islands(cells, count, strides)
    out = (held < SMALL * len(points))[island][number]
    keys, strides = _cells(points, PORE * usual)
    cells, which, count = np.unique(keys, return_inverse=True, return_counts=True)
    few = count <= FEW
    ordered = np.argsort(which)  # by cells: a tree of neighbours in memory is asked faster
    near = ordered[(_about(cells, strides, few)[which] & ~out)[ordered]]
    thin = near[few[which[near]]]
    out[thin] = _apart(points, near, thin)
    return np.asarray(out), island[number]


def _islands(cells: Cells, count: Cells, strides: Cells) -> tuple[Cells, Cells]:
    """Island of every cell, the largest first, and how many points each island holds."""
    pairs = [(a, b) for a, b in (_beside(cells, strides, d) for d in HALF)]
    rows, columns = (np.concatenate([p[i] for p in pairs]) for i in (0, 1))
    graph = coo_matrix((np.ones(len(rows), np.int8), (rows, columns)), shape=(len(cells),) * 2)
    _, island = connected_components(graph, directed=False)
    held = np.bincount(island, count)
    order = np.argsort(-held, kind="stable")
    return np.argsort(order)[island], held[order]


def _about(cells: Cells, strides: Cells, some: Mask) -> Mask:
    """Which of the cells are some of them, or touch these."""
    about = np.zeros(len(cells), bool)
    for d in product((-1, 0, 1), repeat=3):
        about[_beside(cells, strides, d, some)[1]] = True
    return about


def _apart(points: Points, near: Cells, thin: Cells) -> Mask:
    """Which of the points in thin cells stand alone among those near."""
    if len(near) <= NEIGHBOURS:
        return np.ones(len(thin), bool)
    tree = cKDTree(points[near], balanced_tree=False, compact_nodes=False)
    own, beside = map(np.asarray, tree.query(points[thin], NEIGHBOURS + 1, workers=-1))
    asked, back = np.unique(beside[:, 1:], return_inverse=True)
    theirs = np.asarray(tree.query(points[near[asked]], NEIGHBOURS + 1, workers=-1)[0])[:, -1]
    usual = np.median(theirs[back].reshape(len(thin), NEIGHBOURS), axis=1)
    return np.asarray(own[:, -1] > FAR * np.maximum(usual, 1e-12))


def _cells(points: Points, edge: float) -> tuple[Cells, Cells]:
    """Number of the cell of every point, and what a step in x, y, z adds to it."""
    low = points.min(axis=0) - 1.5 * edge
    shape = ((points.max(axis=0) - low) / edge).astype(np.int64) + 3
    strides = np.array([shape[1] * shape[2], shape[2], 1], dtype=np.int64)
    keys = np.zeros(len(points), np.int64)
    for i in range(3):
        keys += ((points[:, i] - low[i]) / edge).astype(np.int64) * strides[i]
    return keys, strides


def _beside(
    cells: Cells, strides: Cells, step: tuple[int, ...], some: Mask | slice = slice(None)
) -> tuple[Cells, Cells]:
    """Numbers of the cells, or some of them, that have a neighbour one step on, and of these."""
    wanted = cells[some] + np.dot(step, strides)
    at = np.minimum(np.searchsorted(cells, wanted), len(cells) - 1)
    found = cells[at] == wanted
    return np.flatnonzero(found), at[found]
