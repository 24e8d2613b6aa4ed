"""Figure 3: the reconstructed surface of the suction side, dense along the span, with its data."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

import numpy as np

from bladecad.arrays import Array, Lines, Vector
from bladecad.replay import ink
from bladecad.replay.draw_data import seen, stand, upright
from bladecad.replay.results import Results
from bladecad.replay.surfaces import away_from_blend, three_surfaces

CLIPPED: Final = 0.15  # of the blade's length: what is further from the data is left out


def figure_3(results: Results, folder: Path) -> None:
    """Draw the paper's surface on the core and on whole sides, and the modal one beside them."""
    figure = ink.canvas(9.0, 4.2)
    frame = upright(results.subjects["full"])
    names = ("paper, " + ink.TITLES["core"], "paper, " + ink.TITLES["full"], "modal, whole side")
    for i, (name, (u, S, data)) in enumerate(zip(names, three_surfaces(results), strict=True)):
        axes: Any = figure.add_subplot(1, 3, i + 1, projection="3d")
        away = away_from_blend(results, u, S, data)
        limit = CLIPPED * results.length
        shown = np.where((away < limit)[..., None], S, np.nan)
        colour = ink.GREEN if i == 2 else ink.BLUE
        axes.plot_surface(*seen(shown, frame).transpose(2, 0, 1), color=colour, alpha=0.55,
                          rcount=len(u), ccount=36, linewidth=0, shade=True)  # fmt: skip
        for line in seen(data, frame):
            axes.plot(*line.T, color=ink.INK, lw=0.5)
        stand(axes, seen(results.subjects["full"].suction.points, frame))
        axes.set_title(_title(name, away, limit), fontsize=8)
    ink.save(figure, folder, "figure3")
    parts = zip(("paper core", "paper full", "modal full"), three_surfaces(results), strict=True)
    rows = [(n, *row) for n, (u, S, _) in parts for row in _rows(u, S)]
    ink.write_table(folder, "figure3", ("surface", "u", "point", "x_mm", "y_mm", "z_mm"), rows)


def _title(name: str, away: Array, limit: float) -> str:
    cut = f"\nnot drawn beyond {ink.millimetres(limit)} mm" if away.max() > limit else "\n"
    return f"{name}\nup to {ink.millimetres(away.max())} mm from the blended data{cut}"


def _rows(u: Vector, S: Lines) -> list[ink.Row]:
    return [
        (float(v), n + 1, *map(float, p))
        for v, line in zip(u, S, strict=True)
        for n, p in enumerate(line)
    ]
