"""Figure 3: the reconstructed surface of the suction side, dense along the span, with its data."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

import numpy as np

from bladecad.arrays import Lines, Vector
from bladecad.replay import ink
from bladecad.replay.curves import distance
from bladecad.replay.draw_data import seen, stand, upright
from bladecad.replay.results import Results
from bladecad.replay.subject import REGIONS

CLIPPED: Final = 0.15  # of the blade's length: what is further from the data is left out


def figure_3(results: Results, folder: Path) -> None:
    """Draw the paper's surface on the core and on whole sides, and the modal one beside them."""
    figure = ink.canvas(9.0, 4.2)
    frame = upright(results.subjects["full"])
    names = ("paper, " + ink.TITLES["core"], "paper, " + ink.TITLES["full"], "modal, whole side")
    for i, (name, (u, S, data)) in enumerate(zip(names, _surfaces(results), strict=True)):
        axes: Any = figure.add_subplot(1, 3, i + 1, projection="3d")
        away = _away(u, S, results, data)
        shown = np.where((away < CLIPPED * results.length)[..., None], S, np.nan)
        colour = ink.GREEN if i == 2 else ink.BLUE
        axes.plot_surface(*seen(shown, frame).transpose(2, 0, 1), color=colour, alpha=0.55,
                          rcount=len(u), ccount=36, linewidth=0, shade=True)  # fmt: skip
        for line in seen(data, frame):
            axes.plot(*line.T, color=ink.INK, lw=0.5)
        stand(axes, seen(results.subjects["full"].suction.points, frame))
        axes.set_title(f"{name}\nup to {ink.millimetres(away.max())} mm from the blended data")
    ink.save(figure, folder, "figure3")
    parts = zip(("paper core", "paper full", "modal full"), _surfaces(results), strict=True)
    rows = [(n, *row) for n, (u, S, _) in parts for row in _rows(u, S)]
    ink.write_table(folder, "figure3", ("surface", "u", "point", "x_mm", "y_mm", "z_mm"), rows)


def _surfaces(results: Results) -> list[tuple[Vector, Lines, Lines]]:
    """Span, surface and data lines of each panel."""
    paper = [(p.u, p.points, results.subjects[r].suction.points) for r, p in results.paper.items()]
    whole = results.subjects["full"].suction
    u = results.paper[REGIONS[1]].u
    return [*paper, (u, results.modal["spline"]("suction", u, whole.t), whole.points)]


def _away(u: Vector, S: Lines, results: Results, data: Lines) -> Lines:
    """Distance of the surface from the data blended linearly along the span, (n, k), mm."""
    span = results.subjects["full"].suction.lines.span
    i = np.clip(np.searchsorted(span, u, side="right") - 1, 0, len(span) - 2)
    v = ((u - span[i]) / (span[i + 1] - span[i]))[:, None, None]
    return distance(S, (1 - v) * data[i] + v * data[i + 1])


def _rows(u: Vector, S: Lines) -> list[ink.Row]:
    return [
        (float(v), n + 1, *map(float, p))
        for v, line in zip(u, S, strict=True)
        for n, p in enumerate(line)
    ]
