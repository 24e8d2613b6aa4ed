"""The overview of a finished blade: what it looks like, and how well it is known."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Final

from matplotlib import rc_context
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from bladecad.export.pictures.panels import (
    GREY,
    INK,
    RED,
    draw_blade,
    draw_edge,
    draw_errors,
    draw_sections,
)
from bladecad.export.pictures.scan_panels import draw_bands
from bladecad.export.product import Product
from bladecad.export.reports.report_solid import brep_distance
from bladecad.written import beside

DPI: Final = 150
GREEN: Final = "#2e7d32"
STYLE: Final[Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 8.5,
    "axes.titlesize": 9,
    "axes.titlepad": 5,
    "axes.edgecolor": GREY,
    "axes.linewidth": 0.7,
    "axes.labelcolor": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.unicode_minus": True,
    "xtick.color": GREY,
    "ytick.color": GREY,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "text.color": INK,
    "legend.fontsize": 7.5,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
}


def draw_overview(product: Product, path: str | os.PathLike[str], *, name: str) -> None:
    """Draw a blade, its sections and their errors on one page, 1800 x 1100 pixels.

    Raises
    ------
    ExportError
        If the file cannot be written.
    """
    with rc_context(STYLE):
        figure = Figure(figsize=(12.0, 7.34), dpi=DPI)
        _heading(figure, product, name)
        draw_blade(figure.add_axes((0.02, 0.09, 0.225, 0.745)), product, "suction")
        draw_blade(figure.add_axes((0.275, 0.09, 0.225, 0.745)), product, "pressure")
        worst = product.fit.errors.worst()[1]
        draw_sections(figure.add_axes((0.56, 0.66, 0.42, 0.21)), product)
        draw_edge(figure.add_axes((0.56, 0.42, 0.19, 0.15)), product, worst, 0)
        draw_edge(figure.add_axes((0.79, 0.42, 0.19, 0.15)), product, worst, 1)
        if product.scanned is None:
            draw_errors(figure.add_axes((0.56, 0.155, 0.42, 0.18)), product)
        else:
            draw_bands(figure.add_axes((0.56, 0.155, 0.375, 0.18)), product, product.scanned)
        _footing(figure, product)
        save_figure(figure, Path(path))


def _heading(figure: Figure, product: Product, name: str) -> None:
    figure.text(0.02, 0.945, name, fontsize=16, weight="bold", va="center")
    figure.text(0.02, 0.905, _read(product), color=GREY, va="center")
    word, colour = ("WITHIN TOLERANCE", GREEN) if product.within else ("OUT OF TOLERANCE", RED)
    figure.text(
        0.985, 0.945, word, fontsize=13, weight="bold", va="center", ha="right", color=colour
    )


def _read(product: Product) -> str:
    """What the blade was built from."""
    if product.scanned is None:
        points = sum(len(section.points) for section in product.sections.sections)
        return f"{len(product.lines.names)} sections, {points} points"
    taken = product.scanned.airfoil.taken
    return f"scan of {len(taken)} points, {taken.sum()} of the airfoil"


def _how_close(product: Product) -> list[str]:
    """How far the surface is from what was measured."""
    fit, um = product.fit, 1e3
    if product.scanned is None:
        return [
            f"fit {um * fit.errors.largest:.3g} µm of {um * fit.tolerance:.3g} µm",
            f"measured points {um * product.deviation.largest:.3g} µm",
        ]
    largest = um * product.scanned.systematic.largest
    return [
        f"mean of places {largest:.2g} µm at most, of {um * fit.tolerance:.3g} µm",
        f"noise {um * product.noise:.2g} µm",
        f"p99 of all points {um * product.deviation.table()[0].p99:.3g} µm",
    ]


def _footing(figure: Figure, product: Product) -> None:
    fit, um = product.fit, 1e3
    facts = [
        str(fit.order or fit.model),
        *_how_close(product),
        f"solid to surface {um * brep_distance(product):.2g} µm",
        f"{product.mesh.chord_error * um:.2g} µm triangles",
    ]
    figure.text(0.02, 0.028, "   ·   ".join(facts), color=GREY, va="center")


def save_figure(figure: Figure, path: Path) -> None:
    """Write a figure as PNG, beside first and then renamed."""
    FigureCanvasAgg(figure)
    with beside(path) as file:
        figure.savefig(file, format="png", metadata={"Software": "bladecad"})
