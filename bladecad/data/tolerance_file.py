"""Tolerance files: TOML, every number checked where it stands. `docs/tolerances.md` describes them.

Tables: [zones] and [parameters] hold bands, [extent] the widths of the zones, [offsets] the places
where edge thickness is measured.
"""

from __future__ import annotations

import os
import re
import tomllib
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, Literal, NoReturn, cast, final

from bladecad.errors import ToleranceError
from bladecad.tolerance import (
    EDGE_ZONE,
    PARAMETERS,
    WIDEST,
    ZONES,
    Band,
    ParameterName,
    Tolerances,
    ZoneName,
    unit_of,
)
from bladecad.tolerance import OFFSETS as EDGE_OFFSETS

Quantity = Literal["length", "angle"]

FORMAT: Final = "bladecad-tolerances/1"
LENGTHS: Final = {"mm": 1.0, "um": 1e-3, "µm": 1e-3, "μm": 1e-3, "in": 25.4, "mil": 0.0254}
ANGLES: Final = {"deg": 1.0, "°": 1.0, "min": 1.0 / 60.0, "mrad": 0.05729577951308232}
LARGEST: Final = {"length": 10.0, "angle": 10.0}  # mm, deg: beyond, the unit is mistaken
NATIVE: Final = {"length": "mm", "angle": "deg"}
BAND_KEYS: Final = ("lower", "upper", "coverage")
OFFSETS: Final = ("leading_edge", "trailing_edge")
EXTENT: Final = (*OFFSETS, "hub_margin", "tip_margin")
TOP: Final = ("format", "unit", "allowed_out", "zones", "extent", "parameters", "offsets")
WITH_UNIT = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(\S+)\s*")


def read_tolerances(path: str | os.PathLike[str]) -> Tolerances:
    """Read a tolerance file.

    Raises
    ------
    ToleranceError
        If it cannot be read, or anything in it is not known, missing, or makes no sense; the
        message names file, table, key, number and bound.
    """
    path = Path(path)
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise ToleranceError(f"{path}: cannot be read: {error.strerror}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise ToleranceError(f"{path.name}: is no TOML: {error}") from error
    return _tolerances(_Place(path.name), table)


@final
@dataclass(frozen=True)
class _Place:
    """Where in the file, for its errors, and the unit of plain lengths there."""

    file: str
    table: str = ""
    key: str = ""
    unit: str = "mm"

    def fail(self, message: str) -> NoReturn:
        where = " ".join(part for part in (self.table and f"[{self.table}]", self.key) if part)
        raise ToleranceError(
            f"{self.file}, {where}: {message}" if where else f"{self.file}: {message}"
        )

    def at(self, key: str) -> _Place:
        return _Place(self.file, self.table, key, self.unit)

    def known(self, keys: Collection[str], names: Collection[str]) -> None:
        for key in keys:
            if key not in names:
                self.at(key).fail(f"unknown key; known are {', '.join(names)}")

    def number(self, value: Any, lowest: float, highest: float) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float):
            self.fail(f"{value!r} is no number")
        if not lowest <= value <= highest:
            self.fail(f"{value:g} is outside {lowest:g} .. {highest:g}")
        return float(value)

    def amount(self, value: Any, quantity: Quantity) -> float:
        """A length in mm or an angle in degrees: a number, or text with a unit behind it."""
        units = LENGTHS if quantity == "length" else ANGLES
        unit = self.unit if quantity == "length" else "deg"
        if isinstance(value, str):
            match = WITH_UNIT.fullmatch(value)
            if not match or match[2] not in units:
                self.fail(
                    f'"{value}" is no {quantity}; write a number and one of {", ".join(units)}'
                )
            value, unit = float(match[1]), match[2]
        bound = LARGEST[quantity]
        if isinstance(value, bool) or not isinstance(value, int | float):
            self.fail(f'{value!r} is no number, nor text such as "0.05 {NATIVE[quantity]}"')
        amount = float(value) * units[unit]
        if not -bound <= amount <= bound:
            self.fail(
                f"{value:g} {unit} is outside +/- {bound:g} {NATIVE[quantity]}; check its unit"
            )
        return amount


def _tolerances(top: _Place, table: Mapping[str, Any]) -> Tolerances:
    top.known(table, TOP)
    if table.get("format", FORMAT) != FORMAT:
        top.at("format").fail(f'"{table["format"]}" is not known; this version reads "{FORMAT}"')
    unit = table.get("unit", "mm")
    if unit not in LENGTHS:
        top.at("unit").fail(f"{unit!r} is not known; known are {', '.join(LENGTHS)}")
    place = _Place(top.file, unit=unit)
    offsets = _offsets(*_table(place, table, "offsets", OFFSETS))
    extent = _extent(*_table(place, table, "extent", EXTENT))
    zones, coverage = _zones(*_table(place, table, "zones", ("default", *map(_key, ZONES))), extent)
    return Tolerances(
        zones=zones,
        coverage=coverage,
        parameters=_parameters(*_table(place, table, "parameters", [*map(_key, PARAMETERS)])),
        allowed_out=top.at("allowed_out").number(table.get("allowed_out", 0.0), 0.0, 1.0),
        le_zone=extent.get("leading_edge", EDGE_ZONE),
        te_zone=extent.get("trailing_edge", EDGE_ZONE),
        hub_margin=extent.get("hub_margin", 0.0),
        tip_margin=extent.get("tip_margin", 0.0),
        le_offsets=offsets.get("leading_edge", EDGE_OFFSETS),
        te_offsets=offsets.get("trailing_edge", EDGE_OFFSETS),
    )


def _table(
    place: _Place, table: Mapping[str, Any], name: str, keys: Collection[str]
) -> tuple[_Place, dict[str, Any]]:
    found = table.get(name, {})
    here = _Place(place.file, name, "", place.unit)
    if not isinstance(found, dict):
        here.fail(f"{found!r} is no table")
    here.known(found, keys)
    return here, found


def _key(name: str) -> str:
    return name.replace(" ", "_")


def _extent(place: _Place, table: Mapping[str, Any]) -> dict[str, float]:
    return {key: place.at(key).number(value, 0.0, WIDEST) for key, value in table.items()}


def _zones(
    place: _Place, table: Mapping[str, Any], extent: Mapping[str, float]
) -> tuple[dict[ZoneName, Band], dict[ZoneName, float]]:
    zones: dict[ZoneName, Band] = {}
    coverage: dict[ZoneName, float] = {}
    for zone in ZONES:
        key = _key(zone) if _key(zone) in table else "default"
        if key in table:
            here = place.at(key)
            zones[zone] = _band(here, table[key], "length")
            if isinstance(table[key], dict) and "coverage" in table[key]:
                coverage[zone] = here.number(table[key]["coverage"], 0.0, 1.0)
        elif not zone.endswith("margin") or extent.get(_key(zone), 0.0) > 0.0:
            place.at(_key(zone)).fail("is missing; give this zone a band, or all others `default`")
    return zones, coverage


def _parameters(place: _Place, table: Mapping[str, Any]) -> dict[ParameterName, Band]:
    found = {}
    for key, value in table.items():
        name = cast(ParameterName, key.replace("_", " "))
        if isinstance(value, dict) and "coverage" in value:
            place.at(key).fail("coverage is asked of zones, not of numbers")
        found[name] = _band(place.at(key), value, "angle" if unit_of(name) == "deg" else "length")
    return found


def _band(place: _Place, value: Any, quantity: Quantity) -> Band:
    """b for +/- b, [lower, upper], or {lower = , upper = }."""
    unit = NATIVE[quantity]
    if isinstance(value, dict):
        place.known(value, BAND_KEYS)
        if not {"lower", "upper"} <= set(value):
            place.fail("needs both lower and upper")
        value = [value["lower"], value["upper"]]
    if not isinstance(value, list):
        half = place.amount(value, quantity)
        if half <= 0.0:
            place.fail(f"a band of +/- {half:g} {unit} is negative or empty; give more than 0")
        return Band(-half, half)
    if len(value) != 2:
        place.fail(f"{len(value)} numbers, a band is [lower, upper]")
    lower, upper = (place.amount(x, quantity) for x in value)
    if upper < lower:
        place.fail(f"upper = {upper:g} {unit} is below lower = {lower:g} {unit}")
    if not (lower <= 0.0 <= upper and lower < upper):
        place.fail(f"{lower:g} .. {upper:g} {unit} does not hold 0; give lower <= 0 <= upper")
    return Band(lower, upper)


def _offsets(place: _Place, table: Mapping[str, Any]) -> dict[str, tuple[float, ...]]:
    return {key: _lengths(place.at(key), value) for key, value in table.items()}


def _lengths(place: _Place, value: Any) -> tuple[float, ...]:
    if not isinstance(value, list):
        place.fail(f"{value!r} is no list of lengths")
    found = tuple(place.amount(x, "length") for x in value)
    for length in found:
        if length < 1e-3:
            place.fail(f"{length:g} mm is no distance from the edge; give at least 0.001 mm")
    return found
