"""What of a scan was taken as airfoil, and what was left: a picture to check the choice by."""

from __future__ import annotations

import os
from pathlib import Path
from textwrap import fill
from typing import Any, Final

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

from bladecad.arrays import Array, Points, Vector
from bladecad.export.pictures.panels import COLOUR, GREY, INK, RED
from bladecad.export.pictures.picture import STYLE, save_figure
from bladecad.scans.judging.scanned import Scanned
from bladecad.scans.judging.support import Gap
from bladecad.scans.moved import moved_points
from bladecad.surface.blade import BladeSurface, SideName, normals
from bladecad.surface.loft import SIDES, graded

MOST: Final = 60_000  # points drawn
LAYERS: Final = 40  # of depth; those of one layer and colour are drawn at once
LEFT, LONELY, GAP = "#b9bec5", RED, "#111111"
PALE: Final = 0.2  # of a colour that is left on the side that faces away
PROBES: Final = np.linspace(0.1, 0.9, 9)
T: Final = graded(201)
ROUND: Final = np.linspace(0.0, 1.0, 21)


def draw_scan(scanned: Scanned, path: str | os.PathLike[str], *, name: str) -> None:
    """Draw a scan from both sides, its airfoil in colour, 1800 x 1200 pixels.

    The upright axis is the height along the stacking axis, as `--span` takes it.

    Raises
    ------
    ExportError
        If the file cannot be written.
    """
    with rc_context(STYLE):
        figure = Figure(figsize=(12.0, 8.0), dpi=150)
        _heading(figure, scanned, name)
        for k, side in enumerate(SIDES):
            _draw_side(figure.add_axes((0.07 + 0.48 * k, 0.15, 0.42, 0.70)), scanned, side)
        figure.legend(
            handles=_legend(scanned), loc="lower center", ncols=6, frameon=False, fontsize=8.5,
            bbox_to_anchor=(0.5, 0.015),
        )  # fmt: skip
        save_figure(figure, Path(path))


def _heading(figure: Figure, scanned: Scanned, name: str) -> None:
    airfoil = scanned.airfoil
    figure.text(0.03, 0.95, f"{name}: what was taken", fontsize=15, weight="bold", va="center")
    axis = ", ".join(f"{a:+.4f}" for a in airfoil.axis)
    taken = int(airfoil.taken.sum())
    figure.text(
        0.03, 0.91,
        f"{taken} of {len(airfoil.taken)} points, from {airfoil.low:.3f} to {airfoil.high:.3f} mm "
        f"({'along' if airfoil.height.kind == 'plane' else airfoil.height.kind + 's about'} "
        f"{axis}); --axis and --span say otherwise",
        color=GREY, va="center",
    )  # fmt: skip
    if airfoil.partial is not None:
        said = fill("; ".join(airfoil.partial.notes), 150)
        figure.text(0.03, 0.89, f"partial blade: {said}", color=RED, va="top", fontsize=9)


def _draw_side(axes: Axes, scanned: Scanned, side: SideName) -> None:
    """Look at one side with the stacking axis upright; what is nearer hides what is behind."""
    back = np.asarray(np.linalg.inv(scanned.transform))
    rows = _rows(scanned.whole.surface, side, scanned.airfoil.axis, back)
    points, kind, colours = _coloured(scanned, side)
    x, y, depth = rows @ points.T
    for layer in np.array_split(np.argsort(depth), LAYERS):
        for k, colour in enumerate(colours):
            own = layer[kind[layer] == k]
            axes.plot(x[own], y[own], "o", ms=1.0, mew=0.0, color=colour, zorder=1.0)
    for u, label in ((0.0, "hub"), (1.0, "tip")):
        _cut(axes, scanned, u, label, rows, back)
    for number, gap in enumerate(scanned.gaps, 1):
        if gap.side == side:
            _mark(axes, scanned.whole.surface, gap, number, rows, back)
    axes.set_aspect("equal")
    axes.set_title(f"{side} side", color=COLOUR[side], fontsize=10)
    axes.set_xlabel("mm")
    axes.set_ylabel("height along the stacking axis, mm")


def _rows(surface: BladeSurface, side: SideName, axis: Vector, back: Array) -> Array:
    """To the right, upwards along the axis, and towards the eye, in the frame of the scan."""
    n = normals(surface, side, PROBES, PROBES).mean(axis=(0, 1)) @ back[:3, :3].T
    towards = n - (n @ axis) * axis
    towards = towards / np.linalg.norm(towards)
    return np.stack([np.cross(axis, towards), axis, towards])


def _coloured(scanned: Scanned, facing: SideName) -> tuple[Points, NDArray[np.int64], list[Any]]:
    """Some points of the scan, what they are, and its colour; the side that faces away is pale."""
    airfoil, away = scanned.airfoil, SIDES[SIDES[0] == facing]
    pale = PALE * np.array(to_rgba(COLOUR[away])) + (1.0 - PALE)
    faces = scanned.whole.feet.suction == (facing == "suction")
    kind = np.zeros(len(airfoil.taken), np.int64)
    kind[airfoil.taken] = np.where(scanned.set_aside, 3, np.where(faces, 2, 1))
    kind[airfoil.lonely] = 3
    some = slice(None, None, max(1, len(kind) // MOST))
    return airfoil.scan.points[some], kind[some], [LEFT, pale, COLOUR[facing], LONELY]


def _cut(axes: Axes, scanned: Scanned, u: float, label: str, rows: Array, back: Array) -> None:
    surface = scanned.whole.surface
    loop = [surface(s, np.array([u]), T)[0] for s in SIDES]
    x, y, _ = rows @ moved_points(np.concatenate([loop[0], loop[1][::-1]]), back).T
    axes.plot(x, y, color=INK, lw=1.2)
    height, off, va = (
        (scanned.airfoil.low, -3, "top") if u == 0.0 else (scanned.airfoil.high, 3, "bottom")
    )
    axes.annotate(f"{label} {height:.2f}", (x.max(), y[x.argmax()]), (0, off), fontsize=8,
                  textcoords="offset points", ha="right", va=va,
                  path_effects=[withStroke(linewidth=3, foreground="white")])  # fmt: skip


def _mark(
    axes: Axes, surface: BladeSurface, gap: Gap, number: int, rows: Array, back: Array
) -> None:
    x, y, _ = rows @ moved_points(_border(surface, gap), back).T
    axes.fill(x, y, fc="none", ec=GAP, hatch="////", lw=1.0)
    axes.annotate(f"gap {number}", (x.mean(), y.max()), (0, 3), fontsize=8, ha="center",
                  textcoords="offset points")  # fmt: skip


def _border(surface: BladeSurface, gap: Gap) -> Points:
    """Round the gap on the surface."""
    u, t = (a + (b - a) * ROUND for a, b in (gap.u, gap.t))
    X = surface(gap.side, u, t)
    return np.concatenate([X[0], X[1:, -1], X[-1, -2::-1], X[-2::-1, 0]])


def _legend(scanned: Scanned) -> list[Line2D | Patch]:
    airfoil, aside = scanned.airfoil, int(scanned.set_aside.sum())
    left = len(airfoil.taken) - int((airfoil.taken | airfoil.lonely).sum())
    dots = [(COLOUR[side], f"airfoil, {side} side") for side in SIDES]
    dots += [
        (LEFT, f"left: {left} points"),
        (LONELY, f"outliers: {int(airfoil.lonely.sum()) + aside}"),
    ]
    found: list[Line2D | Patch] = [
        Line2D([], [], marker="o", ls="", ms=5, color=colour, label=label) for colour, label in dots
    ]
    found.append(Line2D([], [], color=INK, lw=1.2, label="hub and tip of the blade"))
    if scanned.gaps:
        found.append(Patch(fc="none", ec=GAP, hatch="////", label="no points: a gap"))
    return found
