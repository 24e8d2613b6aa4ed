"""A compressor blade of known shape: taper, twist, round or cut-off trailing edge."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from bladecad.arrays import Points, Vector
from bladecad.data.profile import Profile
from bladecad.data.sections import Row, Section, Sections, Source

EDGE_DENSITY = 0.6  # 0: points uniform in phi; towards 1: all at the edges
CUT = 0.97  # of the camber line is left by a blunt trailing edge


def profiles(sections: int = 13, *, hub: float = 180.0, tip: float = 250.0) -> tuple[Profile, ...]:
    """Return the design of a tapered, twisted transonic rotor blade, hub to tip."""
    return tuple(
        Profile(
            height=hub + u * (tip - hub),
            length=56.0 - 3.0 * u**2,
            turning=0.60 - 0.62 * u + 0.14 * u**2,
            stagger=0.64 + 0.50 * u - 0.08 * u**2,
            thickness=4.2 - 2.6 * u + 0.6 * u**2,
            radius_le=0.24 - 0.10 * u,
            radius_te=0.28 - 0.12 * u,
        )
        for u in np.linspace(0, 1, sections)
    )


def synthetic_blade(
    sections: int | Sequence[Profile] = 13,
    points: int = 120,
    *,
    surface: Literal["plane", "cylinder"] = "plane",
    trailing_edge: Literal["round", "blunt"] = "round",
    tagged: bool = False,
) -> Sections:
    """Return a blade about z, points on its exact surface, crowded at the edges.

    Parameters
    ----------
    sections : int or profiles
        How many of `profiles`, or the profiles themselves.
    points : int
        Points a section, both sides together.
    surface : {"plane", "cylinder"}
        Sections in planes x = height, or the same rolled on cylinders of that radius.
    trailing_edge : {"round", "blunt"}
        "blunt" cuts the camber line at 97 %; the loop is then open across the cut.
    tagged : bool
        Whether the edges and sides are said, or left to be found.
    """
    design = profiles(sections) if isinstance(sections, int) else tuple(sections)
    phi = loop_parameters(points, blunt=trailing_edge == "blunt")
    loops = [_on(surface, p.place(p.outline(phi))) for p in design]
    return Sections(
        tuple(_section(f"{k}", loop, phi, tagged) for k, loop in enumerate(loops, 1)),
        Source(None, "synthetic blade", unit_from="file", axis_from="file"),
        Row(blade_count=36),
    )


def loop_parameters(points: int, *, blunt: bool = False) -> Vector:
    """Return phi of every point: from the leading edge round, or from cut to cut if blunt."""
    if not blunt:
        even = 2 * np.pi * np.arange(points) / points
        return even - EDGE_DENSITY / 2 * np.sin(2 * even)
    even = np.linspace(1, -1, points)
    crowded = even - EDGE_DENSITY / 2 / np.pi * np.sin(2 * np.pi * even)
    return float(np.arccos(1 - 2 * CUT)) * crowded


def _on(surface: Literal["plane", "cylinder"], points: Points) -> Points:
    if surface == "plane":
        return points
    x, y, z = points.T
    return np.column_stack([x * np.cos(y / x), x * np.sin(y / x), z])


def _section(name: str, points: Points, phi: Vector, tagged: bool) -> Section:
    closed, last = bool(phi[0] == 0), len(phi) - 1
    if not tagged:
        return Section(name, points, closed)
    le = (int(np.argmin(np.abs(phi))),)
    if not closed:
        return Section(name, points, closed, le, te=(last, 0), suction="second")
    te = (int(np.argmin(np.abs(phi - np.pi))),)
    return Section(name, points, closed, le, te, suction="first")
