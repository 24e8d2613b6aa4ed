"""How far a fit is from the densified lines: between the points as well as at them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import final

import numpy as np

from bladecad.arrays import Array, Points, Vector, seal
from bladecad.curves.sides import BladeLines, Side
from bladecad.fit.samples import Samples, densify
from bladecad.fit.sidefit import SideFit

DENSER = 9  # samples a gap on which a fit is judged, never those it was made to
SPEED = (0.8, 1.25)  # |dX/dt| over the mean side length at a round edge, 1 on the data
SIDES: tuple[Side, Side] = ("suction", "pressure")


@final
@dataclass(frozen=True, eq=False)
class SideErrors:
    """Distances of one side from its densified lines, at equal parameters.

    largest, rms : (m,) float, mm, a section
    place        : (m,) float, parameter t of the largest
    at_points    : (m,) float, mm, the largest at the measured points alone
    """

    largest: Vector
    rms: Vector
    place: Vector
    at_points: Vector

    def __post_init__(self) -> None:
        m = len(self.largest)
        seal(self, largest=(m,), rms=(m,), place=(m,), at_points=(m,))


@final
@dataclass(frozen=True, eq=False)
class Errors:
    """Distances of both sides, and how evenly the edges are run through.

    speed : (lowest, highest) |dX/dt| / Lm at the round edges, 1 on the data
    """

    suction: SideErrors
    pressure: SideErrors
    speed: tuple[float, float]

    @property
    def largest(self) -> float:
        """Largest distance anywhere, mm."""
        return float(max(self.suction.largest.max(), self.pressure.largest.max()))

    @property
    def at_points(self) -> float:
        """Largest distance at the measured points, mm."""
        return float(max(self.suction.at_points.max(), self.pressure.at_points.max()))

    @property
    def rms(self) -> float:
        """Root mean square over both sides, mm."""
        squares = np.concatenate([self.suction.rms**2, self.pressure.rms**2])
        return float(np.sqrt(squares.mean()))

    def worst(self) -> tuple[Side, int, float]:
        """Side, number of the section and parameter t of the largest distance."""
        side: Side = SIDES[int(self.pressure.largest.max() > self.suction.largest.max())]
        errors = self.suction if side == "suction" else self.pressure
        i = int(errors.largest.argmax())
        return side, i, float(errors.place[i])

    def refusal(self, tolerance: float) -> str:
        """Why the fit is not good enough, or nothing."""
        if self.largest > tolerance >= self.at_points:
            return (
                f"{1e3 * self.at_points:.2g} um at the points, but {1e3 * self.largest:.3g} um "
                "between them: more freedom than these points can hold"
            )
        if self.largest > tolerance:
            return f"{1e3 * self.largest:.3g} um where {1e3 * tolerance:.3g} um are allowed"
        low, high = self.speed
        if low < SPEED[0] or high > SPEED[1]:
            return (
                f"the edges are run through at {low:.2f} to {high:.2f} times the speed of the "
                f"data, {SPEED[0]} to {SPEED[1]} is allowed"
            )
        return ""


@final
@dataclass(frozen=True, eq=False)
class Bench:
    """What fits of one blade are judged on; made once, used for every order tried."""

    lines: BladeLines
    dense: tuple[Samples, Samples]

    @staticmethod
    def of(lines: BladeLines) -> Bench:
        """Sample both sides nine times a gap."""
        suction, pressure = (densify(lines, side, DENSER) for side in SIDES)
        return Bench(lines, (suction, pressure))

    @cached_property
    def measured(self) -> dict[Side, list[tuple[Vector, Points]]]:
        """Parameters and places of the measured points, for each section of each side."""
        return {
            side: [
                (t, track(track.fractions()))
                for t, track in zip(self.lines.parameters(side), tracks, strict=True)
            ]
            for side, tracks in self.lines.sides.items()
        }


def judge(bench: Bench, suction: SideFit, pressure: SideFit) -> Errors:
    """Measure both sides on the densified lines."""
    sides = zip((suction, pressure), bench.dense, SIDES, strict=True)
    on_suction, on_pressure = (_side(fit, dense, bench.measured[s]) for fit, dense, s in sides)
    return Errors(on_suction, on_pressure, _speed(bench.lines, suction))


def _side(fit: SideFit, dense: Samples, measured: list[tuple[Vector, Points]]) -> SideErrors:
    d = np.linalg.norm(fit(dense.t) - dense.points, axis=2)
    away = [
        np.linalg.norm(fit.section(i, t) - points, axis=1) for i, (t, points) in enumerate(measured)
    ]
    at_points = np.array([own.max() for own in away])
    largest = np.maximum(d.max(axis=1), at_points)
    return SideErrors(largest, np.sqrt((d**2).mean(axis=1)), dense.t[d.argmax(axis=1)], at_points)


def _speed(lines: BladeLines, fit: SideFit) -> tuple[float, float]:
    round_ends = [end for end, kind in ((0.0, lines.le), (1.0, lines.te)) if kind == "round"]
    if not round_ends:
        return 1.0, 1.0
    X_t = fit(np.array(round_ends), 1)
    ratio: Array = np.linalg.norm(X_t, axis=2) / lines.lengths[:, None]
    return float(ratio.min()), float(ratio.max())
