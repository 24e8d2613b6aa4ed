"""Several blades in one scan, loose or on a common hub: how they part, and what goes with each."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import Final, final

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components, dijkstra
from scipy.spatial import cKDTree

from bladecad.arrays import Points, Vector
from bladecad.scans.finding.axis import stacking_axis
from bladecad.scans.finding.lonely import spacing
from bladecad.scans.finding.slabs import longest_run

LARGE: Final = 0.15  # of the points: an island that may be a blade
BLADE: Final = 0.2  # worth from which an island is one
LAYERS: Final = 24  # into which the scan is cut
FEW: Final = 12_000  # points on which all directions are tried
STARTS: Final = 4  # directions of these that are followed
FULL: Final = 100  # points of a layer that may fall apart
REACH: Final = 3.0  # spacings: neighbours that hold together
STEPS: Final = np.linspace(-1.0, 1.0, 5)
# Directions over the half sphere, none more than 15 degrees away
TRIED: Final = [d for d in product(STEPS, repeat=3) if d > (0, 0, 0) and np.abs(d).max() == 1.0]


@final
@dataclass(frozen=True, eq=False)
class Several:
    """Parts of a scan that do not touch once their common hub is cut away.

    parts  : points of each, (k, 3), mm; blades first
    blades : how many of the parts are blades
    """

    parts: tuple[Points, ...]
    blades: int

    def whose(self, points: Points) -> NDArray[np.int64]:
        """Number of the nearest part of every point, (k,): a hub is shared by its blades."""
        number = np.repeat(np.arange(len(self.parts)), [len(part) for part in self.parts])
        nearest = cKDTree(np.concatenate(self.parts)).query(points, workers=-1)[1]
        return np.asarray(number[nearest])


NONE: Final = Several((), 0)


def loose(points: Points, island: NDArray[np.integer]) -> Several:
    """The large islands of a scan, by number of their points, and how many are blades."""
    held = np.bincount(island)
    large = [k for k in np.argsort(-held, kind="stable") if held[k] > LARGE * len(points)]
    if len(large) < 2:
        return NONE
    parts = [points[island == k] for k in large]
    other = np.array([stacking_axis(part)[1] <= BLADE for part in parts])
    order = np.argsort(other, kind="stable")
    return Several(tuple(parts[k] for k in order), int((~other).sum()))


def on_a_hub(points: Points) -> Several:
    """Blades side by side: the islands between the heights at which the scan falls apart.

    The heights are counted in the direction in which they fall apart most; layers are taken
    off both ends, fillets that still touch, until islands remain. What was cut off goes with the
    island that is nearest along the surface.
    """
    few = points[:: max(len(points) // FEW, 1)]
    graph = _neighbours(few)
    turned = np.array(TRIED) @ np.linalg.svd(few - few.mean(axis=0), full_matrices=False)[2]
    directions = turned / np.linalg.norm(turned, axis=1, keepdims=True)
    runs = [_apart(few @ direction, graph) for direction in directions]
    best = np.argsort([-held for *_, held in runs], kind="stable")[:STARTS]
    found = [_parts(few, graph, few @ directions[k], *runs[k][:2]) for k in best if runs[k][2]]
    return max(found, key=lambda several: several.blades, default=NONE)


def _parts(points: Points, graph: csr_matrix, h: Vector, low: float, high: float) -> Several:
    """The islands between two heights, or closer ones, and what goes with each."""
    step = (high - low) / LAYERS
    for k in range(0, LAYERS // 2, 2):
        inside = np.flatnonzero((h > low + k * step) & (h < high - k * step))
        island = connected_components(graph[inside][:, inside], directed=False)[1]
        found = loose(points[inside], island)
        if found.blades > 1:
            number = np.full(len(points), -1)
            number[inside] = found.whose(points[inside])
            return _grown(points, graph, number, found.blades)
        if found.parts and not found.blades:
            break
    return NONE


def _neighbours(points: Points) -> csr_matrix:
    """Distances of points that are few spacings apart."""
    i, j = cKDTree(points).query_pairs(REACH * spacing(points), output_type="ndarray").T
    away = np.linalg.norm(points[i] - points[j], axis=1)
    return csr_matrix((np.maximum(away, 1e-12), (i, j)), shape=(len(points),) * 2)


def _apart(h: Vector, graph: csr_matrix) -> tuple[float, float, int]:
    """Heights of the run of layers that fall apart; points, times large islands less one."""
    borders = np.linspace(h.min(), h.max(), LAYERS + 1)
    layer = np.clip(np.searchsorted(borders, h, "right") - 1, 0, LAYERS - 1)
    i, j = graph.nonzero()
    same = layer[i] == layer[j]
    within = csr_matrix((np.ones(same.sum(), np.int8), (i[same], j[same])), shape=graph.shape)
    island = connected_components(within, directed=False)[1]
    of_layer = np.zeros(island.max() + 1, np.int64)
    of_layer[island] = layer
    count = np.bincount(layer, minlength=LAYERS)
    large = np.bincount(island) > LARGE * np.maximum(count, FULL)[of_layer]
    more = np.maximum(np.bincount(of_layer[large], minlength=LAYERS) - 1, 0)
    held = np.asarray(count * more, dtype=np.float64)
    first, last = longest_run((more[1:] > 0) & (more[:-1] > 0), held)
    return float(borders[first]), float(borders[last + 1]), int(held[first : last + 1].sum())


def _grown(points: Points, graph: csr_matrix, number: NDArray[np.int64], blades: int) -> Several:
    """All points with the part that is nearest along the surface."""
    source = dijkstra(
        graph, directed=False, indices=np.flatnonzero(number >= 0), min_only=True,
        return_predecessors=True,
    )[2]  # fmt: skip
    whose = np.where(source >= 0, number[np.maximum(source, 0)], -1)
    return Several(tuple(points[whose == k] for k in range(number.max() + 1)), blades)
