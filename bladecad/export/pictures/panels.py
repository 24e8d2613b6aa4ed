"""The panels of the overview: the blade itself, its sections in the flat, the error per section."""

from __future__ import annotations

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, NullFormatter

from bladecad.arrays import Array, Points
from bladecad.curves.develop import develop
from bladecad.export.pictures.scene import render
from bladecad.export.pictures.section_points import section_points
from bladecad.export.pictures.view import view_of
from bladecad.export.product import Product, between_sections
from bladecad.surface.blade import SideName
from bladecad.surface.loft import SIDES, graded

COLOUR: Final = {"suction": "#2f6fa8", "pressure": "#c2603c"}
INK, GREY, RED = "#20242a", "#7a828c", "#b3261e"
LONGER: Final = 620.0  # pixels of the longer side of a blade
T: Final = graded(601)
ZOOM: Final = 12.0  # edge radii across a panel that shows an edge
EDGES: Final = ("leading", "trailing")


def draw_blade(axes: Axes, product: Product, name: SideName) -> None:
    """Draw the blade in light and shade, seen towards one side."""
    surface, mesh = product.surface, product.mesh
    view = view_of(surface, name, mesh.vertices)
    width, height = view.size
    lines = [surface(s, product.lines.span, T) for s in SIDES]
    image = render(mesh, lines, view, LONGER / max(view.size))
    axes.imshow(image, extent=(0.0, width, 0.0, height))
    axes.set_axis_off()
    axes.set_anchor("C")
    axes.set_title(f"{name} side", color=COLOUR[name], fontsize=10)
    for end, label in ((0.0, "LE"), (1.0, "TE")):
        place = view(surface(name, np.array([0.5]), np.array([end]))[0])[0]
        side = -1.0 if place[0] < 0.5 * width else 1.0
        axes.annotate(label, place, (6.0 * side, 0.0), textcoords="offset points",
                      ha="left" if side > 0 else "right", va="center", color=GREY)  # fmt: skip
    _scale_bar(axes, width)


def _scale_bar(axes: Axes, width: float) -> None:
    """A bar of a round length, a fifth of the picture or so."""
    length = _round_length(0.25 * width)
    axes.plot([0.0, length], [-2.5 * width / 50] * 2, color=INK, lw=2, clip_on=False)
    axes.text(0.5 * length, -3.4 * width / 50, f"{length:g} mm", ha="center", va="top", fontsize=8)


def _round_length(most: float) -> float:
    ten = 10.0 ** np.floor(np.log10(most))
    return float(max(step * ten for step in (1.0, 2.0, 5.0) if step * ten <= most))


def draw_sections(axes: Axes, product: Product) -> None:
    """Draw hub, middle and tip section on their chords, points on the fitted line."""
    names = product.lines.names
    floor, longest = 0.0, 0.0
    shown = {len(names) // 2: "middle", len(names) - 1: "tip", 0: "hub"}
    for i in sorted(shown, reverse=True):
        points, sides = on_the_chord(product, i)
        loop = np.concatenate(list(sides.values()))
        lift = np.array([0.0, floor - loop[:, 1].max()])
        for name, line in sides.items():
            axes.plot(*(line + lift).T, lw=1.1, color=COLOUR[name])
        axes.plot(*(points + lift).T, ".", ms=1.8, color=INK, zorder=3)
        label, place = f"{shown[i]}, {quoted(names[i])}", loop[len(T) - 1] + lift
        axes.annotate(label, place, (8, 0), textcoords="offset points", va="center",
                      color=GREY, fontsize=7.5)  # fmt: skip
        longest = max(longest, float(loop[:, 0].max()))
        floor += loop[:, 1].min() - loop[:, 1].max() - 0.05 * np.ptp(loop[:, 0])
    axes.set_xlim(-0.03 * longest, 1.3 * longest)  # room for the names
    axes.set_aspect("equal", anchor="W")
    axes.spines["bottom"].set_bounds(0.0, longest)
    axes.set_xticks([x for x in axes.get_xticks() if 0.0 <= x <= longest])
    axes.set_yticks([])
    axes.spines["left"].set_visible(False)
    axes.set_xlabel("along the chord, mm", labelpad=1, x=0.4)
    axes.set_title("sections on their chords: measured points on the fitted flows", loc="left")


def quoted(name: str, most: int = 22) -> str:
    """Return a name in quotation marks, cut where it is long."""
    return f"“{name if len(name) <= most else name[: most - 1] + '…'}”"


def draw_edge(axes: Axes, product: Product, section: int, edge: int) -> None:
    """Draw one edge of one section large: points against the fitted line; edge 0 leads."""
    points, sides = on_the_chord(product, section)
    radius = _edge_radius(product, section, edge)
    rims = np.array([line[-edge] for line in sides.values()])
    rows = _edge_frame(list(sides.values()), rims.mean(axis=0), 5.0 * radius, edge)
    points, rims, *lines = (
        (x - rims.mean(axis=0)) @ rows.T for x in (points, rims, *sides.values())
    )
    for name, line in zip(sides, lines, strict=True):
        axes.plot(*line.T, lw=1.5, color=COLOUR[name])
    axes.plot(*rims.T, lw=1.5, color=GREY)
    axes.plot(*points.T, "o", ms=3, mfc="white", mec=INK, mew=0.7, zorder=3)
    reach = ZOOM * radius
    axes.set_xlim(*((-0.1 * reach, 0.9 * reach) if edge == 0 else (-0.9 * reach, 0.1 * reach)))
    shape = axes.bbox.height / axes.bbox.width
    axes.set_ylim(-0.5 * reach * shape, 0.5 * reach * shape)
    axes.set_xlabel(f"mm, section {quoted(product.lines.names[section])}", labelpad=1)
    axes.set_title(f"{EDGES[edge]} edge, r = {radius:.2g} mm", loc="left")


def _edge_frame(lines: list[Array], rim: Array, reach: float, edge: int) -> Array:
    """Rows of the frame whose first axis is the camber line at an edge, within `reach` of it."""
    away = [np.linalg.norm(line - rim, axis=1) for line in lines]
    inner = [line[np.abs(d - reach).argmin()] for line, d in zip(lines, away, strict=True)]
    e = (np.mean(inner, axis=0) - rim) * (-1.0 if edge else 1.0)
    e = e / np.linalg.norm(e)
    return np.array([e, [-e[1], e[0]]])


def _edge_radius(product: Product, section: int, edge: int) -> float:
    """Radius of a round edge, half the width of a cut-off one, mm."""
    surface, u, t = (
        product.surface,
        product.lines.span[section : section + 1],
        np.array([float(edge)]),
    )
    if (surface.le, surface.te)[edge] != "round":
        wide = surface("suction", u, t) - surface("pressure", u, t)
        return max(0.5 * float(np.linalg.norm(wide)), 0.05)
    x1, x2 = (surface("suction", u, t, 0, order)[0, 0] for order in (1, 2))
    return float(np.linalg.norm(x1) ** 3 / np.linalg.norm(np.cross(x1, x2)))


def on_the_chord(product: Product, i: int) -> tuple[Points, dict[SideName, Array]]:
    """Measured points and both fitted lines of a section, laid flat together, mm.

    The leading edge is the origin, the chord the first axis, and the suction side above.
    """
    surface, u = product.surface, product.lines.span[i : i + 1]
    measured = section_points(product, i)
    curves = [surface(s, u, T)[0] for s in SIDES]
    flat = develop(np.concatenate([measured, *curves]), product.sections.axis).points
    points, suction, pressure = np.split(flat, [len(measured), len(measured) + len(T)])
    origin = 0.5 * (suction[0] + pressure[0])
    e = 0.5 * (suction[-1] + pressure[-1]) - origin
    e = e / np.linalg.norm(e)
    n = np.array([-e[1], e[0]])
    n = n if (suction - pressure).mean(axis=0) @ n > 0 else -n
    points, suction, pressure = (
        (x - origin) @ np.stack([e, n]).T for x in (points, suction, pressure)
    )
    return points, {"suction": suction, "pressure": pressure}


def draw_errors(axes: Axes, product: Product) -> None:
    """Draw the error of every section on a logarithmic scale, with the tolerance."""
    errors, u, um = product.fit.errors, product.lines.span, 1e3
    for name, side in (("suction", errors.suction), ("pressure", errors.pressure)):
        axes.plot(u, um * side.largest, "o-", ms=4, lw=1, color=COLOUR[name],
                  label=f"{name} side, largest")  # fmt: skip
        axes.plot(u, um * side.rms, "o--", ms=4, lw=0.8, mfc="white", color=COLOUR[name],
                  label=f"{name} side, rms")  # fmt: skip
    left_out = between_sections(product)
    if np.isfinite(left_out).any():
        axes.plot(u, um * left_out, "d:", ms=4, lw=0.8, color=GREY,
                  label="section left out and predicted")  # fmt: skip
    tolerance = um * product.settings.tolerance
    axes.axhline(tolerance, color=RED, lw=1.2)
    axes.annotate(f"tolerance {tolerance:.3g} µm", (0.0, tolerance), (2, 2), color=RED, fontsize=8,
                  textcoords="offset points", va="bottom")  # fmt: skip
    error_axes(axes, tolerance, "error per section: the fit, and the surface between sections")


def error_axes(axes: Axes, tolerance: float, title: str) -> None:
    """Let distances be read on a logarithmic scale, the legend below."""
    axes.set_yscale("log")
    low, high = axes.get_ylim()
    axes.set_ylim(min(low, tolerance / 15.0), max(high, 4.0 * tolerance))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda y, _: f"{y:g}"))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.set_xlabel("span u of the sections, hub 0, tip 1", labelpad=1)
    axes.set_ylabel("distance, µm", labelpad=6)
    axes.set_title(title, loc="left")
    axes.grid(axis="y", lw=0.4, color="#d8dce1")
    handles, labels = axes.get_legend_handles_labels()
    axes.legend(
        handles, labels, ncols=3, loc="upper left", bbox_to_anchor=(-0.02, -0.22), frameon=False
    )
