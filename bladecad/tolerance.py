"""What is allowed: a band for every zone of the blade and for every number of its sections."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Final, Literal, final, get_args

import numpy as np
from numpy.typing import ArrayLike

from bladecad.arrays import Array
from bladecad.errors import ToleranceError

ZoneName = Literal[
    "suction side", "pressure side", "leading edge", "trailing edge", "hub margin", "tip margin"
]
ParameterName = Literal[
    "chord",
    "stagger",
    "twist",
    "bow along",
    "bow across",
    "maximum thickness",
    "maximum thickness place",
    "camber",
    "leading edge radius",
    "trailing edge radius",
    "leading edge thickness",
    "trailing edge thickness",
    "leading edge contour min",
    "leading edge contour max",
    "trailing edge contour min",
    "trailing edge contour max",
    "concave contour min",
    "concave contour max",
    "convex contour min",
    "convex contour max",
]
Unit = Literal["mm", "deg"]

ZONES: Final[tuple[ZoneName, ...]] = get_args(ZoneName)
PARAMETERS: Final[tuple[ParameterName, ...]] = get_args(ParameterName)
ANGLES: Final = frozenset[ParameterName]({"stagger", "twist"})
EDGE_ZONE = 0.02  # of the side's length, as in the deviation table of a build
OFFSETS = (0.5, 1.0)  # mm from the edge
WIDEST = 0.25  # of the side or of the span: a wider edge or margin leaves no blade between


def unit_of(name: ParameterName) -> Unit:
    """Return the unit in which a number and its band are told: angles in degrees, lengths in mm."""
    return "deg" if name in ANGLES else "mm"


@final
@dataclass(frozen=True)
class Band:
    """How far something may be from nominal, mm, or degrees for angles.

    Band(-0.02, 0.05) allows 0.05 mm more metal and 0.02 mm less

    lower, upper : lower <= 0 <= upper, lower < upper
    """

    lower: float
    upper: float

    def __post_init__(self) -> None:
        if not (np.isfinite(self.lower) and np.isfinite(self.upper)):
            raise ToleranceError(f"a band from {self.lower:g} to {self.upper:g} is not finite")
        if not (self.lower <= 0.0 <= self.upper and self.lower < self.upper):
            raise ToleranceError(
                f"a band from {self.lower:g} to {self.upper:g} is no band; give lower <= 0 <= "
                "upper and lower < upper"
            )

    def excess(self, deviation: ArrayLike) -> Array:
        """How far deviations lie outside the band, 0 inside; of the same shape, NaN stays NaN."""
        d = np.asarray(deviation, dtype=np.float64)
        return np.maximum(np.maximum(d - self.upper, self.lower - d), 0.0)

    def __contains__(self, deviation: float) -> bool:
        return self.lower <= deviation <= self.upper


@final
@dataclass(frozen=True)
class Tolerances:
    """What a blade must keep to be good.

    zones            : band of every zone that the blade has, mm
    parameters       : bands of the numbers of a section that are toleranced, mm or degrees
    le_zone, te_zone : width of the edge zones as a share of the side, in t, each way of the edge
    hub_margin, tip_margin : width of the margins as a share of the span, in u; 0 for no margin
    le_offsets, te_offsets : mm from the edge along the chord, where its thickness is measured
    coverage         : least share of a zone's area that must be measured, 0 where not given
    allowed_out      : share of the points of a zone that may lie outside its band

    Raises
    ------
    ToleranceError
        If a zone that the blade has no band, or a number makes no sense.
    """

    zones: Mapping[ZoneName, Band]
    parameters: Mapping[ParameterName, Band] = field(default_factory=dict)
    le_zone: float = EDGE_ZONE
    te_zone: float = EDGE_ZONE
    hub_margin: float = 0.0
    tip_margin: float = 0.0
    le_offsets: tuple[float, ...] = OFFSETS
    te_offsets: tuple[float, ...] = OFFSETS
    coverage: Mapping[ZoneName, float] = field(default_factory=dict)
    allowed_out: float = 0.0

    def __post_init__(self) -> None:
        for name in ("zones", "parameters", "coverage"):
            object.__setattr__(self, name, dict(getattr(self, name)))
        _known("zone", (*self.zones, *self.coverage), ZONES)
        _known("parameter", tuple(self.parameters), PARAMETERS)
        for name in ("le_zone", "te_zone", "hub_margin", "tip_margin"):
            _between(name, getattr(self, name), 0.0, WIDEST)
        for zone, share in self.coverage.items():
            _between(f"coverage of the {zone}", share, 0.0, 1.0)
        _between("allowed_out", self.allowed_out, 0.0, 1.0)
        for name in ("le_offsets", "te_offsets"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
            for offset in getattr(self, name):
                _between(name, offset, 1e-3, 1e3)
        missing = [zone for zone in self.present if zone not in self.zones]
        if missing:
            raise ToleranceError(
                f"no band for the {' and the '.join(missing)}; give every zone of the blade a band"
            )

    @property
    def present(self) -> tuple[ZoneName, ...]:
        """The zones of the blade: without those of no width."""
        width = {
            "leading edge": self.le_zone,
            "trailing edge": self.te_zone,
            "hub margin": self.hub_margin,
            "tip margin": self.tip_margin,
        }
        return tuple(zone for zone in ZONES if width.get(zone, 1.0) > 0.0)


def uniform(tolerance: float) -> Tolerances:
    """Return the same +/- band, mm, for every zone, and none for the numbers of the sections."""
    if not tolerance > 0.0:
        raise ToleranceError(f"a tolerance of {tolerance:g} mm is no tolerance; give more than 0")
    return Tolerances(dict.fromkeys(ZONES, Band(-tolerance, tolerance)))


def _known(what: str, names: tuple[str, ...], known: tuple[str, ...]) -> None:
    for name in names:
        if name not in known:
            raise ToleranceError(f'unknown {what} "{name}"; known are {", ".join(known)}')


def _between(name: str, value: float, lowest: float, highest: float) -> None:
    if not lowest <= value <= highest:
        raise ToleranceError(f"{name} = {value:g} is outside {lowest:g} .. {highest:g}")
