"""The homotopy and the origin as figures."""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np
from matplotlib.axes import Axes

from bladecad.arrays import Array, Vector
from bladecad.replay import ink
from bladecad.replay.origin import Move
from bladecad.replay.results import Results
from bladecad.replay.subject import REGIONS

COLOURS: Final = {"linear": ink.ORANGE, "spline": ink.GREEN}
LIMITS: Final = (3e-4, 1e4)  # mm


def figure_homotopy(results: Results, folder: Path) -> None:
    """Draw crease, leave-one-out error, and the eigenvalues of A(u) along the span."""
    figure = ink.canvas(7.6, 5.4)
    (crease, left_out), below = figure.subplots(2, 2)
    for law, study in results.laws.items():
        for axes, values in ((crease, study.crease), (left_out, study.left_out)):
            axes.semilogy(study.u, values, "o-", ms=3.5, lw=0.8, color=COLOURS[law], label=law)
    crease.set(ylabel="jump of the normal, degrees", title="crease at the sections")
    left_out.set(ylabel="mm", title="section left out, largest distance")
    crease.legend(loc="center right")
    for axes, region in zip(below, REGIONS, strict=True):
        _eigenvalues(axes, results.paper[region].u, results.paper[region].fields)
        axes.set_title(f"eigenvalues of A(u), {ink.TITLES[region]}")
    for axes in figure.axes:
        axes.set_xlabel("span u")
        axes.grid(color=ink.PALE, lw=0.5)
    ink.save(figure, folder, "homotopy")
    _homotopy_tables(results, folder)


def figure_origin(results: Results, folder: Path) -> None:
    """Draw where the error of each model goes when the blade is moved."""
    figure = ink.canvas(7.6, 3.9)
    for axes, region in zip(figure.subplots(1, 2, sharey=True), REGIONS, strict=True):
        _moves(axes, [m for m in results.moves if m.region == region])
        axes.set_title(ink.TITLES[region])
    handles, names = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower center", ncols=2)
    ink.save(figure, folder, "origin")
    header = ("region", "model", "place", "largest_mm", "median_of_lines_mm")
    rows = [
        (m.region, m.rung, place, float(at.largest), float(at.median))
        for m in results.moves
        for place, at in (("here", m.here), ("moved", m.there))
    ]
    ink.write_table(folder, "origin", header, rows)


def _eigenvalues(axes: Axes, u: Vector, fields: Array) -> None:
    values = np.linalg.eigvals(fields)
    axes.plot(u, np.sort(values.real, axis=1), ".", ms=2.5, color=ink.BLUE)
    axes.plot(u, np.sort(values.imag, axis=1), ".", ms=2.5, color=ink.ORANGE)
    axes.plot([], [], ".", color=ink.BLUE, label="real part")
    axes.plot([], [], ".", color=ink.ORANGE, label="imaginary part")
    axes.legend(loc="upper left")


def _moves(axes: Axes, moves: list[Move]) -> None:
    y = np.arange(len(moves))
    here, there = (
        np.clip(np.nan_to_num([s.largest for s in scores], posinf=LIMITS[1]), *LIMITS)
        for scores in ([m.here for m in moves], [m.there for m in moves])
    )
    axes.hlines(y, here, there, color=ink.GREY, lw=1)
    axes.scatter(here, y, s=34, facecolor="white", edgecolor=ink.BLUE, label="as in the file")
    axes.scatter(there, y, s=12, color=ink.ORANGE, zorder=3, label="moved by 100 mm along the axis")
    axes.set(xscale="log", xlim=LIMITS, ylim=(len(moves) - 0.4, -0.6))
    axes.set_yticks(y, [m.rung for m in moves])
    axes.set_xlabel("largest distance, mm")
    axes.grid(axis="x", color=ink.PALE, lw=0.5)
    for m, place in zip(moves, y, strict=True):
        if not min(m.here.largest, m.there.largest) < LIMITS[1]:
            text = f"{ink.millimetres(m.here.largest)}, {ink.millimetres(m.there.largest)}"
            axes.text(0.6 * LIMITS[1], place - 0.15, text, ha="right", va="bottom", fontsize=6.5)


def _homotopy_tables(results: Results, folder: Path) -> None:
    rows = [
        (law, *map(float, row))
        for law, s in results.laws.items()
        for row in zip(s.u, s.crease, s.left_out, strict=True)
    ]
    ink.write_table(folder, "homotopy", ("law", "u", "crease_deg", "left_out_mm"), rows)
    spectra = [
        (region, float(u), float(value.real), float(value.imag))
        for region, p in results.paper.items()
        for u, values in zip(p.u, np.linalg.eigvals(p.fields), strict=True)
        for value in values
    ]
    ink.write_table(folder, "eigenvalues", ("region", "u", "real", "imaginary"), spectra)
