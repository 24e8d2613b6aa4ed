"""A passage as the arrays that the CAD kernel builds its solid from."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.interpolate import make_splprep

from bladecad.arrays import Array, Vector
from bladecad.brep.passage_shape import Line, PassageShape
from bladecad.passage.channel import SIDES, Channel
from bladecad.passage.cylinder import from_cylinder
from bladecad.passage.domain import Passage
from bladecad.passage.periodic import Camber
from bladecad.passage.trim import WALLS, Trimmed, WallName
from bladecad.splines import basis
from bladecad.surface.loft import loft
from bladecad.surface.patch import SplinePatch

BEYOND: Final = 0.01  # of the span, how far the blade reaches beyond both walls
OUTSIDE: Final = 0.02, 0.04  # of sigma and v, how far the periodic face reaches beyond the channel
ALONG, ACROSS = 64, 16  # points of the periodic face
DENSE: Final = 801  # places on a wall
SMOOTHED: Final = 1e-4, 1e-3, 1e-2, 0.1  # mm, the first with which a wall has few enough knots
MOST_KNOTS: Final = 120
WIDER: Final = 0.15  # of the pitch, free in the sector on both sides


def shape_of(passage: Passage, *, tolerance: float = 1e-3) -> PassageShape:
    """Lay out a passage for the kernel; the blade is lofted to `tolerance` mm."""
    blade, channel, camber = passage.blade, passage.channel, passage.camber
    angles = _angles(camber)
    start = float(angles.min()) - (0.5 + WIDER) * passage.pitch
    lines = {
        (name, gap): _line(blade, channel, name, start, gap)
        for name in WALLS
        for gap in {0.0, blade.gap(name)}
    }
    suction, pressure = _sides(blade, tolerance)
    return PassageShape(
        hub=lines["hub", 0.0][0],
        shroud=lines["shroud", 0.0][0],
        hub_end=lines["hub", blade.hub_gap][0] if blade.hub_gap else None,
        tip_end=lines["shroud", blade.tip_gap][0] if blade.tip_gap else None,
        wall_error=max(error for _, error in lines.values()),
        periodic=_periodic(camber, blade.axis, passage.pitch),
        suction=suction,
        pressure=pressure,
        axis=blade.axis,
        sweep=float(angles.max()) + (0.5 + WIDER) * passage.pitch - start,
        pitch=passage.pitch,
        volume=passage.volume,
    )


def longer(patch: SplinePatch, low: float, high: float) -> SplinePatch:
    """The same patch from u = low to high, by its end polynomials where that is beyond; u anew.

    The knots between are kept, so the poles that interpolate the patch at the Greville places of
    the new knots are it, exactly.
    """
    p, knots = patch.degree_u, patch.knots_u
    inner = knots[p + 1 : -p - 1]
    inner = inner[(inner > low) & (inner < high)]
    new = np.concatenate([np.full(p + 1, low), inner, np.full(p + 1, high)])
    places = np.array([new[i + 1 : i + p + 1].mean() for i in range(len(new) - p - 1)])
    rows = np.einsum("ik,klx->ilx", basis(knots, p, places), patch.poles)
    poles = np.einsum("ki,ilx->klx", np.linalg.inv(basis(new, p, places)), rows)
    return SplinePatch(poles, (new - low) / (high - low), patch.knots_t, p, patch.degree_t)


def _sides(blade: Trimmed, tolerance: float) -> tuple[SplinePatch, SplinePatch]:
    """Both sides, a little beyond both ends; poles of a round edge stay one, bit by bit."""
    t = np.linspace(0.0, 1.0, 201)
    ends = [blade.ends(side, t) for side in SIDES]
    low = min(float(u.min()) for u, _ in ends) - BEYOND
    high = max(float(u.max()) for _, u in ends) + BEYOND
    made = loft(blade.surface, tolerance=tolerance)
    return longer(made.suction, low, high), longer(made.pressure, low, high)


def _line(
    blade: Trimmed, channel: Channel, name: WallName, theta: float, gap: float
) -> tuple[Line, float]:
    """A wall, or a line a gap off it, inlet to outlet, and how far they are smoothed off."""
    ends = channel.along(name, np.array([0.0, 3.0]))
    s = np.linspace(ends[0], ends[1], DENSE)
    exact = blade.wall(name).above(s, gap)
    for tolerance in SMOOTHED:
        curve = make_splprep(exact.T, u=s, s=DENSE * tolerance**2)[0]
        if len(curve.t) <= MOST_KNOTS:
            break
    error = float(np.linalg.norm(curve(s).T - exact, axis=1).max())
    zr = curve.c
    poles = from_cylinder(np.column_stack([zr, np.full(len(zr), theta)]), blade.axis)
    return Line(poles, curve.t, curve.k), error


def _periodic(camber: Camber, axis: int, pitch: float) -> Array:
    sigma = np.linspace(-OUTSIDE[0], 3.0 + OUTSIDE[0], ALONG)
    v = np.linspace(-OUTSIDE[1], 1.0 + OUTSIDE[1], ACROSS)
    places = [x.ravel() for x in np.meshgrid(sigma, v, indexing="ij")]
    zrt = np.column_stack([camber.channel(*places), camber(*places) - 0.5 * pitch])
    return from_cylinder(zrt, axis).reshape(ALONG, ACROSS, 3)


def _angles(camber: Camber) -> Vector:
    places = np.meshgrid(np.linspace(0.0, 3.0, 121), np.linspace(0.0, 1.0, 11), indexing="ij")
    return camber(*(x.ravel() for x in places))
