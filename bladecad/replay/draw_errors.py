"""Figures 4 and 5: the maximum absolute and relative error of each suction line."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.axes import Axes

from bladecad.arrays import Vector
from bladecad.replay import ink
from bladecad.replay.curves import distance
from bladecad.replay.results import Results
from bladecad.replay.subject import REGIONS, Region

COLOURS: Final = {"uniform": ink.ORANGE, "arc-length": ink.BLUE, "modal": ink.GREEN}
NAMES: Final = {
    "uniform": "uniform steps",
    "arc-length": "arc-length steps",
    "modal": "modal, whole side",
}
Errors = dict[str, Vector]


def figure_4(results: Results, folder: Path) -> None:
    """Draw the maximum absolute error of each line, mm."""
    _figure(results, folder, "figure4", "maximum absolute error, mm", relative=False)


def figure_5(results: Results, folder: Path) -> None:
    """Draw the maximum relative error of each line."""
    _figure(results, folder, "figure5", "maximum relative error, %", relative=True)


def errors(results: Results, region: Region, *, relative: bool) -> Errors:
    """Errors of each line at its points: both kinds of steps, and the modal fit of whole sides."""
    plain = [p for p in results.plain if p.region == region]
    found = {str(p.spacing): 100 * p.relative if relative else p.absolute for p in plain}
    stretch = results.subjects["full"].suction
    away = distance(results.modal["spline"].suction(stretch.t), stretch.points)
    sizes = np.linalg.norm(stretch.points, axis=2) / 100 if relative else 1.0
    return {**found, "modal": np.asarray((away / sizes).max(axis=1))}


def _figure(results: Results, folder: Path, name: str, quantity: str, *, relative: bool) -> None:
    figure = ink.canvas(7.6, 3.4)
    found = {region: errors(results, region, relative=relative) for region in REGIONS}
    for axes, region in zip(figure.subplots(1, 2, sharey=True), REGIONS, strict=True):
        _bars(axes, found[region])
        axes.set_title(ink.TITLES[region])
        axes.set_xlabel("suction line, 1 at the hub")
    figure.axes[0].set_ylabel(quantity)
    handles, names = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower center", ncols=3)
    ink.save(figure, folder, name)
    header = ("region", "line", *found["core"])
    rows = [
        (region, i + 1, *map(float, row))
        for region, table in found.items()
        for i, row in enumerate(np.transpose(list(table.values())))
    ]
    ink.write_table(folder, name, header, rows)


def _bars(axes: Axes, table: Errors) -> None:
    """Bars on a logarithmic scale; a bar that ends in a number is cut off there."""
    top = 3.0 * max(e[np.isfinite(e)].max(initial=1e-3) for e in table.values())
    width = 0.8 / len(table)
    for i, (name, e) in enumerate(table.items()):
        at = np.arange(1, len(e) + 1) + (i - 1) * width
        axes.bar(
            at, np.where(np.isfinite(e), e, top), width, color=COLOURS[name], label=NAMES[name]
        )
        for x in at[~np.isfinite(e)]:
            axes.text(x, top, "diverges", rotation=90, ha="center", va="top", fontsize=6)
    axes.set_yscale("log")
    axes.set_xlim(0.3, len(e) + 0.7)
    axes.set_xticks(range(1, len(e) + 1, max(1, len(e) // 8)))
    axes.grid(axis="y", color=ink.PALE, lw=0.5)
    axes.set_axisbelow(True)
