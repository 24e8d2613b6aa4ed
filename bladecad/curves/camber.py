"""The camber line of a section: the centres of its inscribed circles."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from bladecad.arrays import Array, Points, Vector, seal
from bladecad.curves.laid import Laid
from bladecad.curves.medial import inscribed, tangents
from bladecad.curves.repair import signed_area

PARALLEL = np.radians(140.0)  # opening of a circle that touches both sides, not one edge
ENDS = 0.03, 0.15  # of the chord from each edge: beyond the circles that touch the edge arcs


@final
@dataclass(frozen=True, eq=False)
class Camber:
    """The camber line in the frame of the chord, from edge to edge.

    x, y   : (n,) float; its points over the chord, suction side up, x rising from 0 to 1
    radius : (n,) float; of the inscribed circles there, over the chord
    """

    x: Vector
    y: Vector
    radius: Vector

    def __post_init__(self) -> None:
        n = len(self.x)
        seal(self, x=(n,), y=(n,), radius=(n,))

    @property
    def bow(self) -> float:
        """Largest offset from the chord, over the chord."""
        return float(self.y[np.abs(self.y).argmax()])

    @property
    def turning(self) -> float:
        """Angle by which the line turns from edge to edge, radians; positive towards suction."""
        return self._lean(self.x, 0.0) - self._lean(1.0 - self.x, 1.0)

    def _lean(self, from_edge: Vector, edge: float) -> float:
        """Angle to the chord at an edge, by the parabola through the stretch beside it."""
        beside = (from_edge > ENDS[0]) & (from_edge < ENDS[1])
        x, y = self.x[beside] - edge, self.y[beside]
        return float(np.arctan(np.polyfit(x, y, 2, w=np.sqrt(np.gradient(x)))[1]))

    @property
    def thickest(self) -> tuple[float, float]:
        """Place along the chord and diameter over chord of the largest inscribed circle."""
        k = int(np.clip(self.radius.argmax(), 1, len(self.radius) - 2))
        x, r = self.x[k - 1 : k + 2], self.radius[k - 1 : k + 2]
        a, b, c = np.polyfit(x - x[1], r, 2)
        place = np.clip(-0.5 * b / a, x[0] - x[1], x[2] - x[1]) if a < 0 else 0.0
        return float(x[1] + place), 2.0 * float(np.polyval([a, b, c], place))


def camber_line(laid: Laid) -> Camber:
    """Return the camber line of a section: the circles that touch both of its sides."""
    hand = 1.0 if signed_area(laid.flat) > 0 else -1.0
    loop = laid.flat * np.array([1.0, hand])
    medial = inscribed(loop, tangents(loop))
    partner = medial.partner.astype(int)
    n = laid.te[0] + 1
    both = (np.arange(len(loop)) < n) & (partner >= laid.te[-1]) & (medial.opening > PARALLEL)
    centres = medial.centres[both] * np.array([1.0, hand])
    return _in_chord_frame(laid, centres, medial.radii[both], hand)


def _in_chord_frame(laid: Laid, centres: Points, radii: Vector, hand: float) -> Camber:
    le, te = laid.ends
    chord = te - le
    length2 = float(chord @ chord)
    up = hand * np.array([chord[1], -chord[0]])
    x, y = (centres - le) @ chord / length2, (centres - le) @ up / length2
    order = _rising(x)
    return Camber(x[order], y[order], radii[order] / np.sqrt(length2))


def _rising(x: Vector) -> Array:
    """Which points lie further along the chord than all before them."""
    return np.append(True, x[1:] > np.maximum.accumulate(x)[:-1])
