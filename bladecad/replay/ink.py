"""How the figures look, and how they are saved: PNG, SVG, and what they show as CSV."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

INK, GREY, PALE = "#263238", "#78909c", "#cfd8dc"
ORANGE, BLUE, GREEN = "#e07b00", "#1f6fb2", "#2e7d32"
TITLES: Final = {"core": "smooth core, 3 to 97 % of the way", "full": "whole side, rounded edges"}
STYLE: Final[Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 8.5,
    "axes.titlesize": 9,
    "axes.edgecolor": GREY,
    "axes.linewidth": 0.7,
    "axes.labelcolor": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.color": GREY,
    "ytick.color": GREY,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "text.color": INK,
    "legend.fontsize": 7.5,
    "legend.frameon": False,
    "svg.fonttype": "path",
    "svg.hashsalt": "bladecad",
    "savefig.facecolor": "white",
}
DPI: Final = 150
Row = Sequence[str | float | int]


def canvas(width: float, height: float) -> Figure:
    """An empty figure, size in inches."""
    figure = Figure(figsize=(width, height), dpi=DPI, layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def save(figure: Figure, folder: Path, name: str) -> None:
    """Write a figure as PNG and SVG, laid out once, the same bytes every time."""
    figure.savefig(folder / f"{name}.png", metadata={"Software": "bladecad"})
    figure.set_layout_engine("none")
    figure.savefig(folder / f"{name}.svg", metadata={"Creator": "bladecad", "Date": None})


def write_table(folder: Path, name: str, header: Sequence[str], rows: Iterable[Row]) -> None:
    """Write what a figure shows; numbers with ten digits, `inf` where a flow diverges."""
    with (folder / f"{name}.csv").open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(header)
        table.writerows([_cell(value) for value in row] for row in rows)


def millimetres(value: float) -> str:
    """A length as one would say it: three digits, or that there is none."""
    if not np.isfinite(value):
        return "diverges"
    if value >= 1e4 or 0 < value < 1e-5:
        return _power(value)
    return np.format_float_positional(value, 3, fractional=False, trim="-")


def label(axes: Axes, text: str) -> None:
    """Say something in the upper left corner of a plot."""
    axes.text(0.02, 0.98, text, transform=axes.transAxes, va="top", ha="left", fontsize=7.5)


def styled() -> Any:
    """The context in which all is drawn."""
    return rc_context(STYLE)


def _power(value: float) -> str:
    digits, exponent = f"{value:.0e}".split("e")
    return f"{digits}e{int(exponent)}"


def _cell(value: str | float | int) -> str | int:
    return f"{value:.10g}" if isinstance(value, float) else value
