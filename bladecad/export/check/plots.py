"""The plots of a check on paper: whiskers of a section, histogram of all deviations."""

from __future__ import annotations

from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from bladecad.arrays import Array
from bladecad.export.check.colours import BAD, BAND, INK, MAP, SOFT, UNKNOWN, line_share
from bladecad.export.check.histogram import Histogram
from bladecad.export.check.whiskers import PARTS, Part, Whiskers

STYLE: Final[Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 9,
    "axes.titlesize": 9.5,
    "axes.titlepad": 6,
    "axes.edgecolor": SOFT,
    "axes.linewidth": 0.7,
    "axes.labelcolor": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "xtick.color": SOFT,
    "ytick.color": SOFT,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "text.color": INK,
    "legend.fontsize": 8,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "svg.fonttype": "none",
    "svg.hashsalt": "bladecad",
}
CLASSES: Final = 15  # of colours of the whiskers
PAGE: Final = (10.0, 6.2)  # inches
MARGIN: Final = 0.05  # of what a view shows
ROOM: Final = 3.0  # times the width of an edge, what may be seen beside it


def section_figure(whiskers: Whiskers, limit: float) -> Figure:
    """Draw a section whole, and its edges large."""
    figure = Figure(figsize=PAGE)
    axes = figure.subplot_mosaic(
        [["section", "section"], ["leading edge", "trailing edge"]],
        height_ratios=(1.25, 1.0),
        gridspec_kw={"left": 0.07, "right": 0.98, "bottom": 0.13, "top": 0.9,
                     "hspace": 0.38, "wspace": 0.16},
    )  # fmt: skip
    figure.text(0.02, 0.955, f"Section {whiskers.name}", fontsize=12, weight="bold")
    figure.text(0.98, 0.955, _extremes(whiskers), ha="right")
    for part in PARTS:
        draw_whiskers(axes[part], whiskers, part, limit)
    _key(figure, axes["section"])
    return figure


def draw_whiskers(axes: Axes, whiskers: Whiskers, part: Part, limit: float) -> None:
    """Draw nominal outline, tolerance band and deviations of a part of a section."""
    m = whiskers.magnification(part)
    lower, upper = (whiskers.moved(bound, m) for bound in whiskers.bounds.T)
    axes.fill(*_ring(lower, upper).T, color=BAND, alpha=0.10, lw=0)
    for bound in (lower, upper):
        axes.plot(*_closed(bound).T, color=BAND, lw=0.7, label="tolerance band")
    axes.plot(*_closed(whiskers.line).T, color=INK, lw=1.0, label="nominal")
    _missing(axes, whiskers)
    _bristles(axes, whiskers, part, limit)
    actual = whiskers.moved(whiskers.deviation, m)
    axes.plot(*_closed(actual).T, color=INK, lw=0.5, ls=(0, (4, 1.5)), label="measured")
    _mark_worst(axes, whiskers, part, actual)
    _window(axes, whiskers, part, np.concatenate([lower, upper, actual]))
    axes.set_title(f"{part}, deviations × {m:g}", loc="left")


def _bristles(axes: Axes, whiskers: Whiskers, part: Part, limit: float) -> None:
    """The whiskers, in few colours and one line of each, so that a file of them is small."""
    shown = whiskers.within(part, wider=ROOM) & np.isfinite(whiskers.deviation)
    d = whiskers.deviation[shown]
    tips = whiskers.moved(whiskers.deviation, whiskers.magnification(part))[shown]
    gaps = np.full_like(tips, np.nan)
    each = np.stack([whiskers.line[shown], tips, gaps], axis=1)
    number = np.rint(line_share(d, limit) * (CLASSES - 1)).astype(int)
    for k in np.unique(number):
        colour = MAP(k / (CLASSES - 1))
        axes.plot(*each[number == k].reshape(-1, 2).T, color=colour, lw=0.9, zorder=1.8)


def _missing(axes: Axes, whiskers: Whiskers) -> None:
    unknown = ~np.isfinite(whiskers.deviation)
    if unknown.any():
        line = np.where(unknown[:, None], whiskers.line, np.nan)
        axes.plot(*line.T, color=UNKNOWN, lw=3.0, solid_capstyle="butt", label="not measured")


def _mark_worst(axes: Axes, whiskers: Whiskers, part: Part, actual: Array) -> None:
    k = whiskers.worst
    if k is None or not whiskers.within(part)[k]:
        return
    colour = BAD if whiskers.excess[k] > 0.0 else INK
    axes.plot(*actual[k], "o", ms=7, mfc="none", mec=colour, mew=1.3, label="worst place")
    paper = {"fc": "white", "ec": "none", "alpha": 0.8, "pad": 1.0}
    axes.annotate(f"{signed(whiskers.deviation[k])} mm", actual[k], (9, 7), bbox=paper, zorder=9,
                  textcoords="offset points", color=colour, weight="bold",
                  annotation_clip=False)  # fmt: skip


def _window(axes: Axes, whiskers: Whiskers, part: Part, drawn: Array) -> None:
    """Show a part to the same scale along and across, with the labels of its axes."""
    part_of = whiskers.within(part)
    seen = np.concatenate([drawn[np.tile(part_of, 3)], whiskers.line[part_of]])
    low, high = np.nanmin(seen, axis=0), np.nanmax(seen, axis=0)
    shape = axes.bbox.height / axes.bbox.width
    wide = (1.0 + 2.0 * MARGIN) * max(float(high[0] - low[0]), float(high[1] - low[1]) / shape)
    half = 0.5 * np.array([wide, wide * shape])
    axes.set_xlim(*(0.5 * (low + high)[0] + half[0] * np.array([-1.0, 1.0])))
    axes.set_ylim(*(0.5 * (low + high)[1] + half[1] * np.array([-1.0, 1.0])))
    axes.set_aspect("equal")
    axes.set_xlabel("along the chord, mm", labelpad=1)
    axes.set_ylabel("across, mm", labelpad=1)


def _key(figure: Figure, axes: Axes) -> None:
    handles, labels = axes.get_legend_handles_labels()
    once = dict(zip(labels, handles, strict=True))
    figure.legend(once.values(), once.keys(), loc="lower left", ncols=5, frameon=False,
                  bbox_to_anchor=(0.01, 0.0))  # fmt: skip
    figure.text(0.98, 0.022, "positive: metal outside the nominal", ha="right", color=SOFT,
                fontsize=8)  # fmt: skip


def _extremes(whiskers: Whiskers) -> str:
    d = whiskers.deviation[np.isfinite(whiskers.deviation)]
    found = f"{signed(d.min())} to {signed(d.max())} mm" if len(d) else "not measured"
    return found if whiskers.name.startswith("u =") else f"u = {whiskers.u:.3g}   {found}"


def draw_histogram(axes: Axes, histogram: Histogram, limit: float) -> None:
    """Draw how many points deviate by how much, with the bands of the zones."""
    middles, width = histogram.middles, np.diff(histogram.edges)
    count = histogram.counts.sum(axis=0)
    axes.bar(middles, count, width, color=MAP(0.5 + 0.5 * np.clip(middles / limit, -1, 1)),
             edgecolor=SOFT, lw=0.3)  # fmt: skip
    for bound in sorted({bound for band in histogram.bands for bound in band}):
        axes.axvline(bound, color=BAND, lw=1.2)
        axes.annotate(signed(bound, None), (bound, 1.0), (0, 0), ha="right", va="top", rotation=90,
                      color=BAND, fontsize=8, xycoords=("data", "axes fraction"),
                      textcoords="offset points")  # fmt: skip
    axes.set_xlim(*histogram.edges[[0, -1]])
    axes.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{y:,.0f}"))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda x, _: signed(x, None)))
    axes.set_xlabel("deviation, mm; positive: metal outside the nominal")
    axes.set_ylabel("points")


def histogram_figure(histogram: Histogram, limit: float) -> Figure:
    """Draw the histogram of all deviations alone."""
    figure = Figure(figsize=(8.0, 3.6))
    axes = figure.add_axes((0.1, 0.15, 0.87, 0.68))
    draw_histogram(axes, histogram, limit)
    figure.text(0.02, 0.93, "Deviation of all points, and the tolerance bands", fontsize=11,
                weight="bold")  # fmt: skip
    figure.text(0.98, 0.93, histogram.beyond, ha="right", color=SOFT)
    return figure


def signed(x: float, digits: int | None = 4) -> str:
    """Return a number with its sign, a real minus, or a dash where there is none."""
    if not np.isfinite(x):
        return "–"
    text = f"{x:+g}" if digits is None else f"{x:+.{digits}f}"
    return "0" if digits is None and x == 0 else text.replace("-", "−")


def _closed(line: Array) -> Array:
    return np.concatenate([line, line[:1]])


def _ring(lower: Array, upper: Array) -> Array:
    """The band between two loops, as one outline that goes there and back."""
    return np.concatenate([_closed(lower), _closed(upper)[::-1]])
