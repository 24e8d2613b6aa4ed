"""The blade as triangles of a given size: named patches, closed, as good as they can be shaped."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from bladecad.arrays import Points, Vector, seal
from bladecad.errors import GeometryError
from bladecad.meshes.edges import edge_zones
from bladecad.meshes.measure import away_from_ruled, away_from_sides
from bladecad.meshes.named import NamedMesh
from bladecad.meshes.numbering import Line, Numbering, number
from bladecad.meshes.quality import Quality, qualities
from bladecad.meshes.sizing import Sizing, chordwise, largest_growth, least_rows, spanwise
from bladecad.meshes.strips import capped, outward_mesh, zipped
from bladecad.surface.blade import BladeSurface
from bladecad.surface.grid import rim
from bladecad.surface.ruled import Triangles

MOST_ROUNDS: Final = 8
LARGEST: Final = 4_000_000  # triangles


@final
@dataclass(frozen=True, eq=False)
class BladePatches:
    """A blade as a closed mesh in named patches.

    mesh        : patches blade_suction, blade_pressure, blade_hub, blade_tip; blade_le and blade_te
                  of round edges (zones near them) and of blunt ones (their faces)
    u, t, s     : (n,) float, parameters of every vertex; s is 0 on the suction side, 1 on the
                  pressure side, and between them on the rulings of hub, tip and blunt edges
    zones       : widths in t of the zones of leading and trailing edge, on the suction and on the
                  pressure side; 0 where the edge is sharp or blunt
    chord_error : mm, largest distance of edge and triangle middles from the surface, measured
    growth      : largest ratio of neighbouring steps along the chord, measured in t
    quality     : of every patch
    """

    mesh: NamedMesh
    u: Vector
    t: Vector
    s: Vector
    zones: tuple[tuple[float, float], ...]
    chord_error: float
    growth: float
    quality: Mapping[str, Quality]

    def __post_init__(self) -> None:
        n = len(self.mesh.vertices)
        seal(self, u=(n,), t=(n,), s=(n,))


def mesh_blade(surface: BladeSurface, sizing: Sizing) -> BladePatches:
    """Mesh a blade straight from S(u,t).

    Parameters
    ----------
    surface : BladeSurface
    sizing : Sizing
        The chord error is measured at the middles of all edges and triangles, and the mesh
        refined until it is met.

    Raises
    ------
    GeometryError
        If that takes more than four million triangles, or a triangle has no area.

    Notes
    -----
    Lines t = const, graded from edge to body, each divided evenly along the span as its neighbours
    are wide; strips of triangles between them. Hub and tip are ruled between both sides at equal t
    (as the faces of the solid are), every ruling divided as its neighbours are wide.
    """
    asked = sizing.chord_error
    for _ in range(MOST_ROUNDS):
        t = chordwise(surface, sizing)
        if 4 * len(t) * least_rows(surface, sizing) > LARGEST:
            break
        rows = spanwise(surface, t, sizing)
        if 4 * sum(map(len, rows)) > LARGEST:
            break
        patches = _meshed(surface, t, rows, sizing)
        if patches.chord_error <= asked:
            _check(patches)
            return patches
        finer = sizing.chord_error * (asked / patches.chord_error) / 1.1
        sizing = replace(sizing, chord_error=finer)
    raise GeometryError(
        f"a chord error of {1e3 * asked:.3g} um at a size of {sizing.size:g} mm takes more than "
        f"{LARGEST:,} triangles; ask for a larger one"
    )


def _meshed(surface: BladeSurface, t: Vector, rows: list[Vector], sizing: Sizing) -> BladePatches:
    numbered = number(surface, t, rows, sizing.size)
    borders = _borders(surface, t)
    S = _sided(numbered.vertices, numbered.suction, *borders[0])
    P = _sided(numbered.vertices, numbered.pressure, *borders[1])
    ruled = _ruled(numbered)
    error = max(
        away_from_sides(surface, "suction", numbered, np.concatenate(S)),
        away_from_sides(surface, "pressure", numbered, np.concatenate(P)),
        away_from_ruled(surface, numbered, np.concatenate(list(ruled.values()))),
        rim(surface, t),
    )
    le, suction, te = S
    around, pressure, behind = (k[:, ::-1] for k in P)
    edges = {"blade_le": np.concatenate([le, around]), "blade_te": np.concatenate([te, behind])}
    faces = {"blade_suction": suction, "blade_pressure": pressure, **edges} | ruled
    used, faces = _renumbered({name: k for name, k in faces.items() if len(k)})
    mesh = outward_mesh(NamedMesh(numbered.vertices[used], faces))
    zones = tuple((float(t[first]), float(1.0 - t[last])) for first, last in borders)
    places = numbered.u[used], numbered.t[used], numbered.s[used]
    return BladePatches(mesh, *places, zones, error, largest_growth(t), qualities(mesh))


def _renumbered(faces: dict[str, Triangles]) -> tuple[Line, dict[str, Triangles]]:
    """Vertices that are used (rulings in round edges are not), and faces in their new numbers."""
    used, which = np.unique(np.concatenate(list(faces.values())), return_inverse=True)
    ends = np.cumsum([len(k) for k in faces.values()])[:-1]
    parts = np.split(which.reshape(-1, 3), ends)
    return used, dict(zip(faces, parts, strict=True))


def _borders(surface: BladeSurface, t: Vector) -> list[tuple[int, int]]:
    """On each side the lines that end the zones of leading and trailing edge: those behind them."""
    found = []
    for le, te in zip(*edge_zones(surface), strict=True):
        first = int(np.searchsorted(t, le - 1e-12))
        last = int(np.searchsorted(t, 1.0 - te + 1e-12, side="right")) - 1
        found.append((first, max(last, first + 1)))
    return found


def _sided(
    vertices: Points, lines: list[Line], first: int, last: int
) -> tuple[Triangles, Triangles, Triangles]:
    """Triangles of one side: leading edge, middle, trailing edge."""
    le, middle, te = lines[: first + 1], lines[first : last + 1], lines[last:]
    return zipped(vertices, le), zipped(vertices, middle), zipped(vertices, te)


def _ruled(numbered: Numbering) -> dict[str, Triangles]:
    """Triangles of hub, tip and blunt edges."""
    v = numbered.vertices
    found = {"blade_hub": capped(v, numbered.hub)[:, ::-1], "blade_tip": capped(v, numbered.tip)}
    if numbered.leading:
        found["blade_le"] = zipped(v, numbered.leading)
    if numbered.trailing:
        found["blade_te"] = zipped(v, numbered.trailing)[:, ::-1]
    return found


def _check(patches: BladePatches) -> None:
    mesh = patches.mesh
    if mesh.open_edges:
        raise GeometryError(
            f"the mesh of the blade has {mesh.open_edges} open edges, 0 are allowed"
        )
    for name, found in patches.quality.items():
        if not found.smallest_area > 1e-12 * found.longest**2:
            raise GeometryError(
                f"{name} has a triangle of {found.smallest_area:.3g} mm^2; "
                "suction and pressure side touch there: mend the section or give a blunt edge"
            )
