"""The channel between hub and shroud in the meridional plane, from inlet to outlet."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final, final

import numpy as np

from bladecad.arrays import Array, Vector, frozen
from bladecad.errors import DataError, GeometryError
from bladecad.passage.cylinder import to_cylinder
from bladecad.passage.trim import Trimmed, WallName
from bladecad.passage.walls import Wall
from bladecad.surface.blade import SideName

STATIONS: Final = np.array([0.0, 1.0, 2.0, 3.0])  # inlet, leading edge, trailing edge, outlet
LEAST: Final = 0.02  # of the meridional chord, between an edge and inlet or outlet
MOST_GAP: Final = 0.2  # of the height between the walls
WITHIN: Final = 1e-9
NEWTON: Final = 40
SIDES: Final[tuple[SideName, SideName]] = ("suction", "pressure")


@final
@dataclass(frozen=True, eq=False)
class Channel:
    """Meridional places by sigma along and v across the flow.

    hub, shroud : Wall
    hub_s, shroud_s : (4,) float, mm; s of inlet, leading edge, trailing edge and outlet, which
                      are sigma = 0, 1, 2, 3

    (z, r)(sigma, v) = (1 - v) hub(s) + v shroud(s), v = 0 at the hub: straight meridional lines.
    """

    hub: Wall
    shroud: Wall
    hub_s: Vector
    shroud_s: Vector

    def __call__(self, sigma: Vector, v: Vector) -> Array:
        """Axial position and radius at the places (sigma_k, v_k), (k, 2) mm."""
        low, high = self._walls(sigma)
        return np.asarray(low + v[:, None] * (high - low))

    def slopes(self, sigma: Vector, v: Vector) -> tuple[Array, Array]:
        """Derivatives of (z, r) by sigma and by v, (k, 2) each."""
        low, high = self._walls(sigma)
        d_low, d_high = self._walls(sigma, 1)
        return d_low + v[:, None] * (d_high - d_low), high - low

    def along(self, name: WallName, sigma: Vector) -> Vector:
        """Parameter s of a wall at sigma, mm."""
        return np.interp(sigma, STATIONS, self.hub_s if name == "hub" else self.shroud_s)

    def locate(self, zr: Array) -> tuple[Vector, Vector]:
        """Find sigma and v of meridional places, (k,) each; Newton from the nearest of a grid."""
        grid_sigma, grid_v, grid = self._grid
        from scipy.spatial import cKDTree

        start = cKDTree(grid).query(zr)[1]
        sigma, v = grid_sigma[start], grid_v[start]
        for _ in range(NEWTON):
            away = self(sigma, v) - zr
            if np.abs(away).max() < WITHIN:
                break
            a, b = self.slopes(sigma, v)
            det = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
            sigma = sigma - (away[:, 0] * b[:, 1] - away[:, 1] * b[:, 0]) / det
            v = v - (a[:, 0] * away[:, 1] - a[:, 1] * away[:, 0]) / det
        else:
            k = int(np.argmax(np.linalg.norm(self(sigma, v) - zr, axis=1)))
            raise GeometryError(
                f"axial position {zr[k, 0]:.5g} mm, radius {zr[k, 1]:.5g} mm is not between hub, "
                "shroud, inlet and outlet; give a larger --inlet or --outlet"
            )
        return sigma, v

    @cached_property
    def _grid(self) -> tuple[Vector, Vector, Array]:
        sigma, v = np.linspace(0.0, 3.0, 181), np.linspace(0.0, 1.0, 31)
        all_sigma, all_v = (x.ravel() for x in np.meshgrid(sigma, v, indexing="ij"))
        return frozen(all_sigma), frozen(all_v), frozen(self(all_sigma, all_v))

    def _walls(self, sigma: Vector, order: int = 0) -> tuple[Array, Array]:
        both = []
        for wall, s in ((self.hub, self.hub_s), (self.shroud, self.shroud_s)):
            piece = np.clip(np.floor(sigma).astype(int), 0, 2)
            rate = np.diff(s)[piece]
            place = s[piece] + rate * (sigma - piece)
            both.append(wall(place, order) * (rate[:, None] if order else 1.0))
        return both[0], both[1]


def channel_of(
    blade: Trimmed, *, inlet: float | None = None, outlet: float | None = None
) -> tuple[Channel, tuple[str, ...]]:
    """Lay the channel round a blade.

    Parameters
    ----------
    blade : Trimmed
        Its walls run from inlet to outlet.
    inlet, outlet : float, mm, optional
        Along hub and shroud, ahead of the leading and behind the trailing edge; else the
        meridional chord there, or as far as the wall reaches.

    Returns
    -------
    Channel, notes

    Raises
    ------
    DataError
        If a wall does not reach as far as asked, or ends at the blade.
    """
    found, notes = [], []
    for name in ("hub", "shroud"):
        s, note = _stations(blade, name, inlet, outlet)
        found.append(frozen(s))
        notes += note
    channel = Channel(blade.hub, blade.shroud, found[0], found[1])
    _check_lines(channel)
    _check_gaps(channel, blade)
    return channel, tuple(notes)


def edges_on(blade: Trimmed, name: WallName) -> Vector:
    """s on a wall beside the leading and the trailing edge, (2,) mm."""
    t = np.array([0.0, 1.0])
    beside = []
    for side in SIDES:
        X = blade.surface.at(side, blade.cut(name, side, t)[0], t)
        beside.append(blade.wall(name).nearest(to_cylinder(X, blade.axis)[:, :2]))
    return np.asarray(np.mean(beside, axis=0))


def _stations(
    blade: Trimmed, name: WallName, inlet: float | None, outlet: float | None
) -> tuple[Vector, list[str]]:
    wall = blade.wall(name)
    s, length, _ = wall.table
    le, te = np.interp(edges_on(blade, name), s, length)
    chord, notes, ends = te - le, [], []
    for what, edge, asked, free, sign in (
        ("inlet", "leading", inlet, le, -1.0),
        ("outlet", "trailing", outlet, length[-1] - te, 1.0),
    ):
        if free < LEAST * chord or (asked is not None and asked > free):
            wanted = LEAST * chord if asked is None else asked
            raise DataError(
                f"the {name} reaches {free:.4g} mm beyond the {edge} edge, {wanted:.4g} mm are "
                f"needed for the {what}; give walls that reach further or a smaller --{what}"
            )
        if asked is not None and asked < LEAST * chord:
            raise DataError(
                f"an {what} {asked:g} mm from the {edge} edge is too near it on the {name}, "
                f"{LEAST * chord:.3g} mm at least are needed; give a larger --{what}"
            )
        distance = min(chord, free) if asked is None else asked
        if asked is None and free < chord:
            notes.append(f"the {name} ends {free:.4g} mm from the {edge} edge: so does the domain")
        ends.append((le if sign < 0 else te) + sign * distance)
    return np.interp([ends[0], le, te, ends[1]], length, s), notes


def _check_gaps(channel: Channel, blade: Trimmed) -> None:
    """A gap is measured along the wall's normal; far from a bent wall that has no one meaning."""
    at = STATIONS[1:3]
    low, high = (channel(at, np.full(2, v)) for v in (0.0, 1.0))
    height = float(np.linalg.norm(high - low, axis=1).min())
    for name, gap in (("hub", blade.hub_gap), ("tip", blade.tip_gap)):
        if gap > MOST_GAP * height:
            raise DataError(
                f"a {name} gap of {gap:g} mm is asked, the passage is {height:.4g} mm high; "
                f"{MOST_GAP * height:.3g} mm at most"
            )


def _check_lines(channel: Channel) -> None:
    """Straight lines from hub to shroud must not cross."""
    sigma, v, grid = channel._grid
    a, b = channel.slopes(sigma, v)
    det = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    if det.min() <= 0.0 <= det.max():
        k = int(np.argmin(np.abs(det)))
        raise GeometryError(
            f"straight lines from hub to shroud cross near axial position {grid[k, 0]:.4g} mm, "
            f"radius {grid[k, 1]:.4g} mm; give a shorter --inlet or --outlet"
        )
