"""The flow domain of one blade: closed, periodic, every patch named, its volume vouched for."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final, final

import numpy as np

from bladecad.arrays import Points, Vector, seal
from bladecad.errors import GeometryError, ToleranceError
from bladecad.meshes.named import NamedMesh
from bladecad.meshes.sizing import Sizing
from bladecad.passage.assemble import meshed
from bladecad.passage.channel import SIDES, Channel
from bladecad.passage.cylinder import from_cylinder, to_cylinder
from bladecad.passage.periodic import Camber, camber_of, clearance
from bladecad.passage.steps import ROUND
from bladecad.passage.trim import WALLS, Trimmed
from bladecad.passage.volume import passage_volume
from bladecad.surface.loft import graded
from bladecad.surface.ruled import Triangles

VOLUME: Final = 1e-4  # relative, of the mesh against the quadrature
SAFE: Final = 0.7  # of the chord error, asked of what is laid out by estimates
MOST_ROUNDS: Final = 6
STUCK: Final = 0.8  # of the last worst: a finer mesh that gains less, while it is still so many
FAR_OFF: Final = 2.0  # times off what is allowed, is not what is missing
LARGEST: Final = 4_000_000  # triangles


@final
@dataclass(frozen=True, eq=False)
class Passage:
    """The fluid round one blade of a row.

    mesh         : patches inlet, outlet, hub, shroud, periodic_1, periodic_2, blade_suction,
                   blade_pressure; blade_le and blade_te where they are round or blunt; blade_tip
                   before a tip gap, blade_hub before a hub gap
    blade        : the trimmed blade
    channel, camber : its meridional plane, and the periodic faces half a pitch from the camber
    count        : blades in the row
    angle        : radians, theta somewhere on the blade
    twins        : (k, 2) int, vertices of periodic_1 and those of periodic_2 that they turn onto
    volume       : mm^3, by quadrature
    volume_error : relative, of the mesh against it
    trim_error   : mm, largest distance of the blade's ends from the walls, less the gaps
    period_error : mm, largest distance of twins after turning by the pitch
    chord_error  : mm, largest distance of triangles from blade and walls, measured
    clearance    : mm, least distance of blade and periodic faces in the direction of rotation
    inside       : (3,) float, mm, a place in the fluid
    notes        : what was settled without being asked
    """

    mesh: NamedMesh
    blade: Trimmed
    channel: Channel
    camber: Camber
    count: int
    angle: float
    twins: Triangles
    volume: float
    volume_error: float
    trim_error: float
    period_error: float
    chord_error: float
    clearance: float
    inside: Vector
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        seal(self, inside=(3,))

    @property
    def pitch(self) -> float:
        """Angle from blade to blade, radians."""
        return 2.0 * np.pi / self.count


def mesh_passage(
    blade: Trimmed, channel: Channel, count: int, sizing: Sizing, *, notes: tuple[str, ...] = ()
) -> Passage:
    """Mesh the surface of the periodic flow domain of one blade.

    Parameters
    ----------
    blade : Trimmed
    channel : Channel
    count : int
        Blades in the row.
    sizing : Sizing
        The chord error is measured on blade and walls, and the mesh refined until it is met and
        the volume is within 1e-4 of the quadrature.

    Raises
    ------
    GeometryError
        If the blade crosses its periodic faces, the mesh does not close, or would take more than
        four million triangles.
    ToleranceError
        If there are fewer than two blades.
    """
    if count < 2:
        raise ToleranceError(f"{count} blades in the row; a passage needs 2 at least")
    angle = _somewhere(blade)
    camber = camber_of(blade, channel, angle)
    free = clearance(_scattered(blade), camber, blade.axis, angle, 2.0 * np.pi / count)
    volume = passage_volume(blade, channel, count, angle)
    on_walls = on_sides = replace(sizing, chord_error=SAFE * sizing.chord_error)
    _check_number(triangles_at_least(channel, count, on_walls), on_walls)
    before = np.inf
    for _ in range(MOST_ROUNDS):
        mesh, twins, errors = meshed(blade, camber, angle, count, on_walls, on_sides)
        missing = abs(mesh.volume / volume - 1.0)
        by_wall, by_side = (max(e / sizing.chord_error, missing / VOLUME) for e in errors)
        worst = max(by_wall, by_side)
        _check_number(len(mesh.triangles), sizing)
        if worst <= 1.0 or worst > max(FAR_OFF, STUCK * before):
            break
        _check_number(len(mesh.triangles) * worst, sizing)
        before = worst
        on_walls, on_sides = _finer(on_walls, by_wall), _finer(on_sides, by_side)
    if worst > 1.0:
        raise GeometryError(
            f"the mesh of the passage is {1e3 * max(errors):.3g} um off blade and walls, "
            f"{1e3 * sizing.chord_error:.3g} um are allowed, its volume {missing:.2g} (relative), "
            f"{VOLUME:g} allowed; ask for a smaller size or a larger chord error"
        )
    ends = [blade.cut(name, side, np.linspace(0, 1, 201))[1] for name in WALLS for side in SIDES]
    X = mesh.vertices
    return Passage(
        mesh, blade, channel, camber, count, angle, twins, volume, missing, max(ends),
        _apart(X, twins, blade.axis, 2.0 * np.pi / count), max(errors), free,
        _fluid(camber, blade), notes,
    )  # fmt: skip


def triangles_at_least(channel: Channel, count: int, sizing: Sizing) -> float:
    """Estimate from below how many triangles walls and periodic faces take."""
    sigma = np.linspace(0.0, 3.0, 61)
    low, high = (channel(sigma, np.full_like(sigma, v)) for v in (0.0, 1.0))
    runs = [np.linalg.norm(np.diff(zr, axis=0), axis=1) for zr in (low, high)]
    height = float(np.linalg.norm(high - low, axis=1).min())
    found = 2.0 * 2.0 * min(run.sum() for run in runs) * height / sizing.size**2
    for run, zr in zip(runs, (low, high), strict=True):
        r = 0.5 * (zr[1:, 1] + zr[:-1, 1])
        h = np.minimum(sizing.size, np.sqrt(ROUND * r * sizing.chord_error))
        found += float(np.sum(2.0 * (2.0 * np.pi / count) * r * run / h**2))
    return float(found)


def _check_number(triangles: float, sizing: Sizing) -> None:
    if triangles > LARGEST:
        raise GeometryError(
            f"a size of {sizing.size:g} mm and a chord error of {1e3 * sizing.chord_error:.3g} um "
            f"would take {triangles:.2g} triangles, {LARGEST:.2g} at most are made; ask for larger"
        )


def _finer(sizing: Sizing, worst: float) -> Sizing:
    return replace(sizing, chord_error=sizing.chord_error / (1.1 * worst)) if worst > 1 else sizing


def _apart(X: Points, twins: Triangles, axis: int, pitch: float) -> float:
    """Largest difference of twins in axial position, radius and, less the pitch, angle, mm."""
    first, second = (to_cylinder(X[ids], axis) for ids in twins.T)
    away = second - first
    turn = np.remainder(away[:, 2] - pitch + np.pi, 2.0 * np.pi) - np.pi
    return float(np.abs([away[:, 0], away[:, 1], first[:, 1] * turn]).max())


def _somewhere(blade: Trimmed) -> float:
    """theta in the middle of the blade."""
    half = np.array([0.5])
    return float(to_cylinder(blade.surface("suction", half, half), blade.axis)[0, 0, 2])


def _scattered(blade: Trimmed) -> Points:
    """Points all over both sides of the trimmed blade."""
    v, t = (x.ravel() for x in np.meshgrid(np.linspace(0, 1, 33), graded(161), indexing="ij"))
    return np.concatenate([blade.at(side, v, t) for side in SIDES])


def _fluid(camber: Camber, blade: Trimmed) -> Vector:
    """A place half-way from inlet to leading edge, in the middle of the passage."""
    sigma, v = np.array([0.5]), np.array([0.5])
    zrt = np.column_stack([camber.channel(sigma, v), camber(sigma, v)])
    return np.asarray(from_cylinder(zrt, blade.axis)[0])
