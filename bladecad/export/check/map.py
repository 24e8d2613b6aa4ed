"""A map for the eye: with fewer cells, and without the small gaps that count as measured."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Vector
from bladecad.deviation.inspecting.coverage import Map

MOST: Final = 8000  # cells a side that are drawn


def coarser(chart: Map) -> Map:
    """Join neighbouring cells of a map until there are few enough to be drawn."""
    while chart.count[0].size > MOST:
        axis = 1 if len(chart.u) > len(chart.t) else 2
        chart = _halved(chart, axis)
    return chart


def _halved(chart: Map, axis: int) -> Map:
    first = np.arange(0, chart.count.shape[axis], 2)

    def joined(values: NDArray[Any], add: np.ufunc = np.add) -> Array:
        return np.asarray(add.reduceat(values, first, axis=axis))

    count = joined(chart.count)
    total = joined(np.where(chart.count > 0, chart.mean * chart.count, 0.0))
    area = joined(chart.area)
    covered = joined(chart.area * chart.measured)
    return Map(
        _fewer(chart.u) if axis == 1 else chart.u,
        _fewer(chart.t) if axis == 2 else chart.t,
        count.astype(np.int64),
        np.where(count > 0, total / np.maximum(count, 1), np.nan),
        joined(chart.lowest, np.fmin),
        joined(chart.highest, np.fmax),
        area,
        covered >= 0.5 * area,
    )


def _fewer(borders: Vector) -> Vector:
    return np.append(borders[:-1][::2], borders[-1])


def bridged(chart: Map) -> Map:
    """Give a measured cell without points the mean of the cells beside it, and their extremes."""
    names: tuple[str, ...] = ("mean", "lowest", "highest")
    mean, lowest, highest = (_bridged(getattr(chart, name), chart.measured) for name in names)
    return Map(
        chart.u, chart.t, chart.count, mean, lowest, highest, chart.area, chart.measured
    )  # fmt: skip


def _bridged(values: Array, measured: NDArray[np.bool_]) -> Array:
    found = values.copy()
    while (gaps := measured & np.isnan(found)).any():
        padded = np.pad(found, ((0, 0), (1, 1), (1, 1)), constant_values=np.nan)
        sides = (
            padded[:, :-2, 1:-1],
            padded[:, 2:, 1:-1],
            padded[:, 1:-1, :-2],
            padded[:, 1:-1, 2:],
        )
        beside = np.stack(sides)
        known = np.isfinite(beside).sum(axis=0)
        filled = gaps & (known > 0)
        if not filled.any():
            break
        found[filled] = np.nansum(beside, axis=0)[filled] / known[filled]
    return found
