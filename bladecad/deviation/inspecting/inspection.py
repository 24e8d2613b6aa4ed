"""The whole inspection: a scan against a nominal, and the verdict."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import TYPE_CHECKING, final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Points
from bladecad.data.scan import Scan
from bladecad.deviation.inspecting.coverage import Map, map_of
from bladecad.deviation.inspecting.worst import Worst as Worst
from bladecad.deviation.inspecting.worst import worst_places
from bladecad.deviation.inspecting.zones import ZoneResult, excess, zone_of, zone_results
from bladecad.deviation.nearest.feet import Feet
from bladecad.deviation.nearest.nominal import Nominal
from bladecad.deviation.nearest.project import project
from bladecad.deviation.nearest.referee import Referee
from bladecad.deviation.sectioning.parameters import Number
from bladecad.deviation.sectioning.section_result import SectionResult
from bladecad.deviation.sectioning.sections import section_results
from bladecad.errors import DataError
from bladecad.one_thread import one_thread
from bladecad.tolerance import Tolerances

if TYPE_CHECKING:
    from bladecad.deviation.registering.registration import Registration


@final
@dataclass(frozen=True, eq=False)
class Inspection:
    """A scan measured against a nominal.

    nominal, scan : what was compared
    registration  : what moved the scan onto the nominal
    feet          : of the moved points
    zone          : (k,) int8, number in `ZONES` of each point's zone, -1 beyond the span
    zones         : what was found on each zone that the blade has
    map           : the skin in cells, with what the scan did not reach
    sections      : what was found on each station
    worst         : worst places, worst first, each of another neighbourhood
    referee       : what trimesh said to a sample of the distances
    tolerances    : what was allowed
    beyond        : points beyond the span, which have no deviation
    seconds       : that projection, zones, sections and so on took, by name
    """

    nominal: Nominal
    scan: Scan
    registration: Registration
    feet: Feet
    zone: NDArray[np.int8]
    zones: tuple[ZoneResult, ...]
    map: Map
    sections: tuple[SectionResult, ...]
    worst: tuple[Worst, ...]
    referee: Referee | None
    tolerances: Tolerances
    beyond: int
    seconds: dict[str, float]

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why the blade is not good, the zones first; empty where it is."""
        return tuple(self._reasons())

    @property
    def within(self) -> bool:
        """Whether every zone and every number of every section keeps its band."""
        return not self.reasons

    def _reasons(self) -> Iterator[str]:
        for zone in self.zones:
            yield from zone.reasons
        for section in self.sections:
            for number in section.numbers:
                if number.within is False:
                    yield f'section "{section.name}": {_told(number)}'


def inspect(
    nominal: Nominal,
    scan: Scan,
    *,
    registration: Registration,
    tolerances: Tolerances,
    stations: Sequence[float] | Mapping[str, float] | None = None,
    referee: Callable[[Points, Feet], Referee] | None = None,
    axis: int = 2,
) -> Inspection:
    """Measure a scan against a nominal: zones, sections, worst places, and what is not measured.

    Parameters
    ----------
    nominal, scan : Nominal, Scan
    registration : Registration
        What moves the scan onto the nominal.
    tolerances : Tolerances
    stations : (m,) float or {name: float}, optional
        Span u of the sections to be measured; those that the nominal is made of if not given.
    referee : function of points and feet, optional
        Lets trimesh measure a sample of the moved points, such as `confirm` with a mesh.
    axis : {0, 1, 2}
        Column of the machine axis, which stagger is told against.

    Raises
    ------
    DataError
        If no point lies on the blade, or a station beyond it.
    GeometryError
        If the referee disagrees.
    """
    clock = _Clock()
    named = _named(nominal.surface.span if stations is None else stations)
    points = _moved(registration, scan.points)
    feet = project(nominal, points)
    if feet.rim.all():
        raise DataError(
            f"{scan.source.path or 'the scan'}: none of its {len(feet.rim)} points lies between "
            "hub and tip of the nominal; check units and registration"
        )
    clock.lap("projection")
    said = referee(points, feet) if referee else None
    clock.lap("referee")
    zone = zone_of(feet, tolerances)
    out = excess(feet.distance, zone, tolerances)
    map_ = map_of(nominal, feet, tolerances)
    zones = zone_results(feet, zone, out > 0.0, map_, tolerances)
    worst = worst_places(feet, zone, out, named)
    clock.lap("zones")
    with one_thread():
        sections = section_results(nominal, feet, named, tolerances, axis=axis)
    clock.lap("sections")
    beyond = int(np.count_nonzero(feet.rim))
    return Inspection(
        nominal, scan, registration, feet, zone, zones, map_, sections, worst, said, tolerances,
        beyond, clock.seconds,
    )  # fmt: skip


class _Clock:
    """Seconds since the last lap, by name."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self._last = perf_counter()

    def lap(self, name: str) -> None:
        now = perf_counter()
        self.seconds[name], self._last = now - self._last, now


def _moved(registration: Registration, points: Points) -> Points:
    T = registration.T_nominal_scan
    return np.asarray(points @ T[:3, :3].T + T[:3, 3])


def _named(
    stations: Sequence[float] | NDArray[np.float64] | Mapping[str, float],
) -> dict[str, float]:
    if isinstance(stations, Mapping):
        named = {str(name): float(u) for name, u in stations.items()}
    else:
        named = {f"u = {u:.4g}": float(u) for u in stations}
    for name, u in named.items():
        if not 0.0 <= u <= 1.0:
            raise DataError(f'station "{name}" at u = {u:g} is not on the blade, u is 0 .. 1')
    if not named:
        raise DataError("no station is given; name at least one u, 0 .. 1")
    return named


def _told(number: Number) -> str:
    """One number out of its band, in words."""
    assert number.band is not None
    if number.deviation is None:
        return f"{number.name} is not known: {number.reason}"
    bounds = f"{number.band.lower:+g} .. {number.band.upper:+g} {number.unit}"
    return f"{number.name} is off by {number.deviation:+.4f} {number.unit}, allowed are {bounds}"
