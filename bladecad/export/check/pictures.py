"""The pictures of a check as PNG: the blade in its colours, every section, the histogram."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import numpy as np
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize, to_rgb
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter

from bladecad.arrays import Array
from bladecad.deviation.inspecting.inspection import Inspection, Worst
from bladecad.export.check.colours import BAND, CAP, INK, MAP, SOFT, UNKNOWN, colours
from bladecad.export.check.histogram import Histogram
from bladecad.export.check.mesh import CAP as END
from bladecad.export.check.mesh import Painted
from bladecad.export.check.plots import STYLE, histogram_figure, section_figure, signed
from bladecad.export.check.whiskers import Whiskers
from bladecad.export.pictures.scene import lines_actor, painted_actor, render_actors
from bladecad.export.pictures.view import View, view_of
from bladecad.surface.blade import SideName
from bladecad.surface.loft import SIDES, graded

DPI: Final = 150
LONGER: Final = 640.0  # pixels of the longer side of a blade
T: Final = graded(301)
MARKED: Final = 5  # worst places


def blade_figure(inspection: Inspection, blade: Painted, limit: float) -> Figure:
    """Draw both sides of the blade in the colours of its deviation, the worst places marked."""
    figure = Figure(figsize=(10.0, 6.6))
    for k, side in enumerate(SIDES):
        axes = figure.add_axes((0.02 + 0.49 * k, 0.15, 0.47, 0.78))
        _draw_side(axes, inspection, blade, side, limit)
    _colour_bar(figure.add_axes((0.22, 0.085, 0.46, 0.022)), inspection, limit)
    figure.text(0.735, 0.096, "■", va="center", color=UNKNOWN, fontsize=15)
    figure.text(0.762, 0.096, "not measured", va="center")
    return figure


def _draw_side(
    axes: Axes, inspection: Inspection, blade: Painted, side: SideName, limit: float
) -> None:
    surface = inspection.nominal.surface
    view = view_of(surface, side, blade.vertices)
    u = np.array([section.u for section in inspection.sections])
    lines = [surface(s, u, T) for s in SIDES] if len(u) else []
    body = painted_actor(blade.vertices, blade.triangles, face_colours(blade, limit))
    image = render_actors([body, *map(lines_actor, lines)], view, LONGER / max(view.size))
    axes.imshow(image, extent=(0.0, view.size[0], 0.0, view.size[1]))
    axes.set_axis_off()
    axes.set_title(f"{side} side")
    _edges(axes, inspection, side, view)
    for number, worst in enumerate(inspection.worst[:MARKED], 1):
        if worst.side == side:
            _mark(axes, view, worst, number)


def face_colours(blade: Painted, limit: float) -> Array:
    """Return the colour of every triangle, (m, 3): of its mean, grey where not measured."""
    paint = colours(np.nan_to_num(blade.mean), limit)
    paint[~blade.measured | np.isnan(blade.mean)] = to_rgb(UNKNOWN)
    paint[blade.zone == END] = to_rgb(CAP)
    return paint


def _mark(axes: Axes, view: View, worst: Worst, number: int) -> None:
    place = view(worst.point[None])[0]
    axes.plot(*place, "o", ms=9, mfc="none", mec=INK, mew=1.3)
    axes.annotate(f"{number}: {signed(worst.deviation, 3)}", place, (8, 6), fontsize=8,
                  textcoords="offset points", annotation_clip=False,
                  bbox={"fc": "white", "ec": "none", "alpha": 0.75, "pad": 1.0})  # fmt: skip


def _edges(axes: Axes, inspection: Inspection, side: SideName, view: View) -> None:
    surface = inspection.nominal.surface
    for end, label in ((0.0, "LE"), (1.0, "TE")):
        place = view(surface(side, np.array([0.5]), np.array([end]))[0])[0]
        left = place[0] < 0.5 * view.size[0]
        axes.annotate(label, place, (-8 if left else 8, 0), textcoords="offset points",
                      ha="right" if left else "left", va="center", color=SOFT,
                      annotation_clip=False)  # fmt: skip


def _colour_bar(axes: Axes, inspection: Inspection, limit: float) -> None:
    scale = ScalarMappable(Normalize(-limit, limit), MAP)
    bar = axes.figure.colorbar(scale, cax=axes, orientation="horizontal", extend="both")
    bar.ax.xaxis.set_major_formatter(FuncFormatter(lambda x, _: signed(x, None)))
    bar.set_label("mean deviation, mm; positive: metal outside the nominal")
    for bound in {bound for z in inspection.zones for bound in (z.band.lower, z.band.upper)}:
        bar.ax.axvline(bound, color=BAND, lw=1.5)


def figures(
    inspection: Inspection,
    blade: Painted,
    sections: list[Whiskers],
    histogram: Histogram,
    limit: float,
) -> Iterator[tuple[str, Figure]]:
    """Give every picture with the name of its file, one at a time; draw each before the next."""
    yield "overview", blade_figure(inspection, blade, limit)
    yield "histogram", histogram_figure(histogram, limit)
    for number, whiskers in enumerate(sections, 1):
        yield f"section-{number:02d}-{slug(whiskers.name)}", section_figure(whiskers, limit)


def write_pngs(pictures: Iterator[tuple[str, Figure]], folder: Path) -> list[Path]:
    """Write pictures as PNG files."""
    written = []
    with rc_context(STYLE):
        for name, figure in pictures:
            path = folder / f"{name}.png"
            figure.savefig(path, dpi=DPI, metadata={"Software": "bladecad"})
            written.append(path)
    return written


def as_svg(figure: Figure) -> str:
    """Return a figure as SVG, the coordinates of its paths rounded to a hundredth of a point."""
    text = io.StringIO()
    figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    return re.sub(r' d="[^"]*"', _rounded, text.getvalue())


def _rounded(path: re.Match[str]) -> str:
    return re.sub(r"\d+\.\d+", lambda x: f"{float(x.group()):.2f}", path.group())


def as_png(figure: Figure, dpi: int) -> bytes:
    """Return a figure as the bytes of a PNG file."""
    file = io.BytesIO()
    figure.savefig(file, format="png", dpi=dpi)
    return file.getvalue()


def slug(name: str) -> str:
    """Return a name that any file system takes."""
    return re.sub(r"[^A-Za-z0-9]+", "-", name).strip("-")[:40] or "section"
