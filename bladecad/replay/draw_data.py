"""Figure 1, the data; figure 2, the suction lines with uniform and with arc-length steps."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes

from bladecad.arrays import Array, Lines, Points
from bladecad.replay import ink
from bladecad.replay.plain import Plain
from bladecad.replay.results import Results
from bladecad.replay.subject import REGIONS, SIDE_NAMES, Subject

LIFT: Final = 0.19  # of a chord between neighbouring lines
MARGIN: Final = 0.12  # of a chord, to both sides of the data: what is further off is clipped


def figure_1(results: Results, folder: Path) -> None:
    """Scatter the points of both sides, whole and core."""
    figure = ink.canvas(7.6, 4.6)
    frame = upright(results.subjects["full"])
    for i, region in enumerate(REGIONS):
        axes: Any = figure.add_subplot(1, 2, i + 1, projection="3d")
        for side, colour in zip(
            results.subjects[region].sides, (ink.BLUE, ink.ORANGE), strict=True
        ):
            axes.scatter(*seen(side.points, frame).reshape(-1, 3).T, s=2.2, lw=0, color=colour)
        stand(axes, seen(results.subjects["full"].suction.points, frame))
        axes.set_title(ink.TITLES[region])
    figure.legend(
        handles=[_dot(axes, c, n) for c, n in ((ink.BLUE, "suction"), (ink.ORANGE, "pressure"))],
        loc="outside lower center", ncols=2,
    )  # fmt: skip
    ink.save(figure, folder, "figure1")
    header = ("region", "side", "line", "point", "x_mm", "y_mm", "z_mm")
    ink.write_table(
        folder, "figure1", header, [r for s in results.subjects.values() for r in _rows(s)]
    )


def figure_2(results: Results, folder: Path) -> None:
    """Draw every suction line in its own plane, lifted one above the other."""
    figure = ink.canvas(6.4, 7.2)
    for axes, region in zip(figure.subplots(1, 2), REGIONS, strict=True):
        plain = [p for p in results.plain if p.region == region]
        _lines(axes, plain)
        worst = " and ".join(ink.millimetres(p.absolute.max()) for p in plain)
        axes.set_title(f"{ink.TITLES[region]}\nlargest error {worst} mm")
        axes.set_xlabel("along the chord, mm")
    figure.axes[0].set_ylabel("across, lines lifted one above the other, mm")
    handles, names = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside lower center", ncols=3)
    ink.save(figure, folder, "figure2")
    header = ("region", "steps", "line", "point", "x_mm", "y_mm", "z_mm")
    rows = [(p.region, p.spacing, *row) for p in results.plain for row in _numbered(p.curves)]
    data = [
        (s.region, "data", *row)
        for s in results.subjects.values()
        for row in _numbered(s.suction.points)
    ]
    ink.write_table(folder, "figure2", header, data + rows)


def upright(subject: Subject) -> Array:
    """A frame in which the blade stands: along the chord, across, and from hub to tip, (3, 3)."""
    points = subject.suction.points
    up = _unit(points[-1].mean(axis=0) - points[0].mean(axis=0))
    chord = (points[:, -1] - points[:, 0]).mean(axis=0)
    along = _unit(chord - up * (chord @ up))
    return np.array([along, np.cross(up, along), up])


def seen(points: Lines, frame: Array) -> Lines:
    """Coordinates in a frame."""
    return np.asarray(points @ frame.T)


def stand(axes: Any, points: Lines) -> None:
    """Show the box of some points at true proportions, with little round them."""
    flat = points.reshape(-1, 3)
    low, high = np.nanmin(flat, axis=0), np.nanmax(flat, axis=0)
    middle, half = (low + high) / 2, 0.53 * np.maximum(high - low, 0.25 * np.max(high - low))
    for name, m, h in zip("xyz", middle, half, strict=True):
        getattr(axes, f"set_{name}lim")(m - h, m + h)
    axes.set_box_aspect(half, zoom=0.92)
    axes.view_init(18, -62)
    axes.set_xlabel("chord, mm")
    axes.set_zlabel("span, mm")
    axes.locator_params(nbins=5)
    axes.set_yticks([])


def _lines(axes: Axes, plain: list[Plain]) -> None:
    data = plain[0].stretch.points
    size = float(np.linalg.norm(data[:, -1] - data[:, 0], axis=1).max())
    for i, points in enumerate(data):
        lift = np.array([0.0, i * LIFT * size])
        colours = ((p.curves[i], c) for p, c in zip(plain, (ink.ORANGE, ink.BLUE), strict=True))
        for (curve, colour), name in zip(
            colours, ("uniform steps", "arc-length steps"), strict=True
        ):
            axes.plot(
                *(_own_plane(curve, points) + lift).T,
                color=colour,
                lw=0.9,
                label="_" * (i > 0) + name,
            )
        axes.plot(
            *(_own_plane(points, points) + lift).T,
            ".",
            color=ink.INK,
            ms=1.3,
            label="_" * (i > 0) + "data",
        )
    axes.set_xlim(-MARGIN * size, (1 + MARGIN) * size)
    axes.set_ylim(-1.2 * MARGIN * size, (len(data) * LIFT + MARGIN) * size)
    axes.set_aspect("equal")


def _own_plane(curve: Points, points: Points) -> Points:
    """Coordinates along the chord of a line and towards its belly, from its first point, (k, 2)."""
    along = _unit(points[-1] - points[0])
    belly = (points - points[0]).sum(axis=0)
    across = _unit(belly - along * (belly @ along))
    return np.asarray((curve - points[0]) @ np.array([along, across]).T)


def _unit(v: Array) -> Array:
    return np.asarray(v / np.linalg.norm(v))


def _dot(axes: Any, colour: str, name: str) -> Any:
    return axes.plot([], [], ".", color=colour, label=name)[0]


def _rows(subject: Subject) -> list[ink.Row]:
    sides = zip(SIDE_NAMES, subject.sides, strict=True)
    return [(subject.region, n, *row) for n, side in sides for row in _numbered(side.points)]


def _numbered(lines: Lines) -> list[ink.Row]:
    return [
        (i + 1, n + 1, *map(float, p)) for i, line in enumerate(lines) for n, p in enumerate(line)
    ]
