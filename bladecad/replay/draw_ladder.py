"""The ladder as a figure: every rung, the replayed blade in colour, all others behind it."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.axes import Axes

from bladecad.replay import ink
from bladecad.replay.ladder import RUNGS, Step
from bladecad.replay.results import Results
from bladecad.replay.subject import REGIONS

LIMITS: Final = (3e-5, 1e4)  # mm; what lies beyond is drawn at the border, with its number


def figure_ladder(results: Results, folder: Path) -> None:
    """Draw the largest and rms distance from the densified lines, one row a rung."""
    figure = ink.canvas(8.4, 4.6)
    for axes, region in zip(figure.subplots(1, 2, sharey=True), REGIONS, strict=True):
        steps = [s for s in results.ladder if s.region == region]
        _others(axes, [s for s in steps if s.blade != results.blade.name])
        _own(axes, [s for s in steps if s.blade == results.blade.name])
        axes.set(xscale="log", xlim=LIMITS, ylim=(len(RUNGS) - 0.4, -0.6))
        axes.set_yticks(range(len(RUNGS)), list(RUNGS))
        axes.set_title(ink.TITLES[region])
        axes.set_xlabel("distance at the same parameter, mm")
        axes.grid(axis="x", color=ink.PALE, lw=0.5)
    handles, names = figure.axes[1].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower center", ncols=3)
    ink.save(figure, folder, "ladder")
    header = ("blade", "region", "rung", "coefficients", "largest_at_points_mm", "largest_mm",
              "rms_mm", "median_of_lines_mm")  # fmt: skip
    ink.write_table(
        folder, "ladder", header, [(*s[:4], *map(float, s.score)) for s in results.ladder]
    )


def _own(axes: Axes, steps: list[Step]) -> None:
    y = np.arange(len(steps))
    largest, rms = (_within([getattr(s.score, n) for s in steps]) for n in ("largest", "rms"))
    colours = [ink.GREEN if "modal" in s.rung else ink.GREY if "spline" in s.rung else ink.BLUE
               for s in steps]  # fmt: skip
    axes.hlines(y, rms, largest, color=colours, lw=1.2)
    axes.scatter(largest, y, s=24, color=colours, zorder=3, label=f"{steps[0].blade}: largest")
    axes.scatter(rms, y, s=20, facecolor="white", edgecolor=colours, zorder=3, label="rms")
    for s, place in zip(steps, y, strict=True):
        if not s.score.largest < LIMITS[1]:
            text = ink.millimetres(s.score.largest)
            axes.text(0.75 * LIMITS[1], place - 0.2, text, ha="right", va="bottom", fontsize=6.5)


def _others(axes: Axes, steps: list[Step]) -> None:
    rows = list(RUNGS)
    y = [rows.index(s.rung) for s in steps]
    axes.scatter(_within([s.score.largest for s in steps]), y, s=22, marker="|", lw=0.7,
                 color=ink.GREY, alpha=0.8, label="other blades: largest")  # fmt: skip


def _within(values: list[float]) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    return np.clip(np.nan_to_num(values, posinf=LIMITS[1]), *LIMITS)
