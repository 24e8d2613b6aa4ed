"""All files of a replay."""

from __future__ import annotations

from pathlib import Path

from bladecad.replay import ink
from bladecad.replay.draw_data import figure_1, figure_2
from bladecad.replay.draw_errors import figure_4, figure_5
from bladecad.replay.draw_ladder import figure_ladder
from bladecad.replay.draw_studies import figure_homotopy, figure_origin
from bladecad.replay.draw_surface import figure_3
from bladecad.replay.page import page
from bladecad.replay.results import Progress, Results

FIGURES = (
    figure_1, figure_2, figure_3, figure_4, figure_5,
    figure_ladder, figure_homotopy, figure_origin,
)  # fmt: skip


def write(results: Results, folder: Path, progress: Progress = lambda _: None) -> None:
    """Draw all figures into a folder."""
    with ink.styled():
        for draw in FIGURES:
            progress(draw.__name__.replace("_", " "))
            draw(results, folder)


def write_page(results: Results, file: Path, images: str = "") -> None:
    """Write the page that explains the figures."""
    file.write_text(page(results, images), encoding="utf-8")
