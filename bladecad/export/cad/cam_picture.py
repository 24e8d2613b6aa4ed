"""The CAM sheet as one picture."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from bladecad.cam.flank import Flank
from bladecad.cam.sheet import CamSheet
from bladecad.export.pictures.panels import COLOUR, GREY, INK, LONGER, RED
from bladecad.export.pictures.picture import DPI, GREEN, STYLE, save_figure
from bladecad.export.pictures.scene import render
from bladecad.export.pictures.view import view_of
from bladecad.surface.blade import BladeSurface
from bladecad.surface.loft import SIDES, graded
from bladecad.surface.triangulate import triangulate

SHOWN: Final = 40  # passes drawn on the blade
T: Final = graded(401)
SIZE: Final = {"round": "radius", "blunt": "width", "sharp": "sharp"}


def draw_cam(
    surface: BladeSurface, sheet: CamSheet, path: str | os.PathLike[str], *, name: str
) -> None:
    """Draw a CAM sheet on one page, 1800 x 1100 pixels.

    Raises
    ------
    ExportError
        If the file cannot be written.
    """
    with rc_context(STYLE):
        figure = Figure(figsize=(12.0, 7.34), dpi=DPI)
        _heading(figure, sheet, name)
        _draw_passes(figure.add_axes((0.01, 0.08, 0.25, 0.76)), surface, sheet)
        worst = max(side.largest for side in sheet.flanks)
        for side, left in zip(sheet.flanks, (0.32, 0.64), strict=True):
            _draw_flank(figure, figure.add_axes((left, 0.56, 0.26, 0.28)), side, worst)
        _draw_twist(figure.add_axes((0.32, 0.10, 0.19, 0.32)), sheet)
        _draw_edges(figure.add_axes((0.56, 0.10, 0.19, 0.32)), sheet)
        _draw_thickness(figure, figure.add_axes((0.80, 0.10, 0.14, 0.32)), sheet)
        save_figure(figure, Path(path))


def _heading(figure: Figure, sheet: CamSheet, name: str) -> None:
    cut = sheet.cutting
    figure.text(0.02, 0.945, name, fontsize=16, weight="bold", va="center")
    text = f"ball of radius {cut.ball:g} mm, scallops of {1e3 * cut.scallop:.3g} µm"
    figure.text(0.02, 0.905, text, color=GREY, va="center")
    word, colour = ("FLANK MILLING", GREEN) if sheet.flank_millable else ("POINT MILLING", RED)
    figure.text(0.985, 0.945, word, fontsize=13, weight="bold", va="center", ha="right",
                color=colour)  # fmt: skip
    told = f"a flank would be {sheet.flank_error:.3g} mm off, {cut.tolerance:.3g} mm are allowed"
    figure.text(0.985, 0.905, told, color=GREY, va="center", ha="right")


def _draw_passes(axes: Axes, surface: BladeSurface, sheet: CamSheet) -> None:
    """Draw the blade with some of the passes along the chord."""
    size = float(np.ptp(surface("suction", T, T), axis=(0, 1)).max())
    mesh = triangulate(surface, chord_error=1e-3 * size)
    view = view_of(surface, "suction", mesh.vertices)
    width, height = view.size
    every = max(len(sheet.chordwise.at) // SHOWN, 1)
    lines = [surface(s, sheet.chordwise.at[::every], T) for s in SIDES]
    image = render(mesh, lines, view, LONGER / max(view.size))
    axes.imshow(image, extent=(0.0, width, 0.0, height))
    axes.set_axis_off()
    axes.set_anchor("C")
    each = f", one in {every} drawn" if every > 1 else ""
    axes.set_title(f"{len(sheet.chordwise.at)} passes along the chord{each}")


def _draw_flank(figure: Figure, axes: Axes, side: Flank, worst: float) -> None:
    shown = np.where(side.counted, side.deviation, np.nan)
    limit = max(worst, 1e-6)
    image = axes.pcolormesh(side.t, side.v, shown, cmap="RdBu_r", vmin=-limit, vmax=limit,
                            shading="nearest", rasterized=True)  # fmt: skip
    bar = figure.colorbar(image, ax=axes, pad=0.02, aspect=25)
    bar.outline.set_visible(False)
    axes.set_xlabel("t at the hub, LE 0, TE 1", labelpad=1)
    axes.set_ylabel("along the ruling")
    axes.set_title(f"{side.side} side: best ruled surface off by {side.largest:.3g} mm",
                   loc="left", color=COLOUR[side.side])  # fmt: skip


def _draw_twist(axes: Axes, sheet: CamSheet) -> None:
    for side in sheet.flanks:
        axes.plot(side.t, np.degrees(side.twist), lw=1.2, color=COLOUR[side.side], label=side.side)
    axes.set_xlabel("t at the hub, LE 0, TE 1", labelpad=1)
    axes.set_ylim(bottom=0.0)
    axes.set_title("twist of the normal along a ruling, deg", loc="left")
    axes.legend(frameon=False)


def _draw_edges(axes: Axes, sheet: CamSheet) -> None:
    for edge, label, style in ((sheet.le, "leading", "-"), (sheet.te, "trailing", "--")):
        text = f"{label}, {SIZE[edge.kind]}"
        axes.plot(edge.size, sheet.u, style, lw=1.2, color=INK, label=text)
    axes.set_xlim(left=0.0)
    axes.set_ylabel("span u, hub 0, tip 1")
    axes.set_xlabel("mm", labelpad=1)
    axes.set_title("edges", loc="left")
    axes.legend(frameon=False)


def _draw_thickness(figure: Figure, axes: Axes, sheet: CamSheet) -> None:
    found = sheet.thickness
    image = axes.pcolormesh(found.t, found.u, found.diameter, cmap="viridis", shading="gouraud",
                            rasterized=True)  # fmt: skip
    bar = figure.colorbar(image, ax=axes, pad=0.04, aspect=25)
    bar.outline.set_visible(False)
    axes.set_xlabel("t, LE 0, TE 1", labelpad=1)
    axes.set_title("thickness, mm", loc="left")
