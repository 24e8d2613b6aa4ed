"""A scan checked against its nominal: read both, register, measure, judge."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from os import PathLike
from pathlib import Path
from typing import Any, Final, TypeAlias, final

import numpy as np

from bladecad.arrays import Points
from bladecad.data.read_scan import read_scan
from bladecad.data.scan import Scan
from bladecad.data.scan_clean import cleaned
from bladecad.data.sections import Source, Unit
from bladecad.data.tolerance_file import read_tolerances
from bladecad.deviation.inspecting.inspection import Inspection, inspect
from bladecad.deviation.registering.pose import Freedom
from bladecad.deviation.registering.registration import Kind, register
from bladecad.errors import DataError, ToleranceError
from bladecad.pipeline.clock import Clock, Progress
from bladecad.pipeline.nominal import (
    LoadedNominal,
    NominalSettings,
    load_nominal,
    nominal_of_surface,
)
from bladecad.surface.blade import BladeSurface
from bladecad.tolerance import Tolerances, uniform

AnyNominal: TypeAlias = str | PathLike[str] | BladeSurface | LoadedNominal
AnyScan: TypeAlias = str | PathLike[str] | Points | Scan
AnyTolerance: TypeAlias = str | PathLike[str] | float | Tolerances

EDGE: Final = 0.05  # of the side: nearer to an edge a point may be of either
ONE_SIDED: Final = 0.02  # of the points: a side with fewer of them was not scanned


@final
@dataclass(frozen=True)
class CheckSettings:
    """How a scan is checked.

    CheckSettings()                                  best fit, file units as the files say
    CheckSettings(fit="none")                        the scan as it stands
    CheckSettings(locked=("z",))                     a best fit that does not shift along z

    fit      : "best" or "none"
    locked   : coordinates of the pose that the best fit leaves at zero
    unit     : of the scan, where its file does not say
    stations : span u of the sections in the report, 0 .. 1; else those of the nominal
    partial  : take a scan of one side alone
    nominal  : how the nominal is read
    """

    fit: Kind = "best"
    locked: tuple[Freedom, ...] = ()
    unit: Unit | None = None
    stations: tuple[float, ...] | None = None
    partial: bool = False
    nominal: NominalSettings = field(default_factory=NominalSettings)

    def __post_init__(self) -> None:
        if self.locked and self.fit == "none":
            raise ToleranceError(
                f"{', '.join(self.locked)} locked, but nothing is fitted; lock without fit none"
            )


@final
@dataclass(frozen=True, eq=False)
class Check:
    """A scan, checked.

    name       : of the scan
    settings   : what was asked for
    inputs     : nominal, scan and tolerance: file, SHA-256, format, unit
    notes      : what was guessed, dropped or repaired, and how to say otherwise
    inspection : deviations, zones, sections, verdict
    """

    name: str
    settings: CheckSettings
    inputs: Mapping[str, Mapping[str, Any]]
    notes: tuple[str, ...]
    inspection: Inspection

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why the blade is out of tolerance, one sentence each."""
        return self.inspection.reasons

    @property
    def within(self) -> bool:
        """Whether the blade is within its tolerances."""
        return self.inspection.within


def check(
    nominal: AnyNominal,
    scan: AnyScan,
    tolerance: AnyTolerance,
    settings: CheckSettings = CheckSettings(),
    *,
    name: str | None = None,
    progress: Progress = lambda _: None,
) -> Check:
    """Check a scan against its nominal.

    Parameters
    ----------
    nominal : path, BladeSurface or LoadedNominal
        A model file, sections, a STEP or a mesh; or a surface that is at hand.
    scan : path, Scan or (k, 3) float, mm
    tolerance : path, Tolerances or float
        A tolerance file, or the same +/- band in mm for all zones.
    settings : CheckSettings
    name : str, optional
        Of the blade; else that of the file of the scan.
    progress : callable
        Told the name of each step as it begins.

    Raises
    ------
    DataError
        If a file cannot be read, the scan is of another blade, in other units or mirrored.
    ToleranceError
        If a tolerance makes no sense.
    GeometryError
        If trimesh disagrees with the distances.
    """
    tolerances = tolerances_of(tolerance)
    clock = Clock(progress)
    with clock.step("read the scan"):
        measured = scan_of(scan, settings.unit)
    with clock.step("read the nominal"):
        loaded = nominal_from(nominal, settings.nominal, progress)
    with clock.step("register"):
        registration = register(
            loaded.nominal, measured.points, fit=settings.fit, locked=settings.locked
        )
    with clock.step("measure"):
        stations = settings.stations or loaded.stations
        found = inspect(
            loaded.nominal, measured, registration=registration, tolerances=tolerances,
            stations=stations, referee=loaded.confirm, axis=loaded.axis,
        )  # fmt: skip
    if not settings.partial:
        _refuse_one_sided(found)
    return Check(
        name or _name(measured),
        settings,
        _inputs(loaded, measured, tolerance),
        (*loaded.notes, *measured.source.notes, *registration.notes),
        replace(found, seconds=_seconds(clock.seconds, found.seconds)),
    )


def tolerances_of(tolerance: AnyTolerance) -> Tolerances:
    """Return what is allowed: a file, a number in mm, or the value itself."""
    if isinstance(tolerance, Tolerances):
        return tolerance
    if isinstance(tolerance, str | PathLike):
        return read_tolerances(tolerance)
    return uniform(float(tolerance))


def scan_of(scan: AnyScan, unit: Unit | None = None) -> Scan:
    """Return a scan: read from a file, or an array of points."""
    if isinstance(scan, Scan):
        return scan
    if isinstance(scan, str | PathLike):
        return read_scan(scan, unit=unit)
    points = np.asarray(scan, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3:
        raise DataError(f"an array of shape {points.shape} is no scan; (k, 3) is needed, mm")
    points, _, dropped = cleaned(points)
    return Scan(points, None, Source(None, "array", notes=dropped))


def nominal_from(
    nominal: AnyNominal, settings: NominalSettings, progress: Progress = lambda _: None
) -> LoadedNominal:
    """Return a nominal: read from a file, or a surface at hand."""
    if isinstance(nominal, LoadedNominal):
        return nominal
    if isinstance(nominal, BladeSurface):
        return nominal_of_surface(nominal, axis="xyz".index(settings.axis or "z"))
    return load_nominal(Path(nominal), settings, progress=progress)


def _refuse_one_sided(found: Inspection) -> None:
    feet = found.feet
    on_blade = ~feet.rim & (feet.t > EDGE) & (feet.t < 1.0 - EDGE)
    share = float(np.mean(feet.suction[on_blade])) if on_blade.any() else 0.5
    if ONE_SIDED <= share <= 1.0 - ONE_SIDED:
        return
    side, other = ("pressure", "suction") if share < 0.5 else ("suction", "pressure")
    count = int(on_blade.sum())
    raise DataError(
        f"{found.scan.source.path or 'the scan'}: {max(share, 1.0 - share):.1%} of its {count} "
        f"points off the edges lie on the {side} side, the {other} side was not scanned; scan it, "
        "or give --partial to judge the one side alone"
    )


def _name(scan: Scan) -> str:
    return scan.source.path.stem if scan.source.path else "scan"


def _seconds(steps: Mapping[str, float], parts: Mapping[str, float]) -> dict[str, float]:
    """Wall time of each step, that of measuring in its parts."""
    return {name: s for name, s in steps.items() if name != "measure"} | dict(parts)


def _inputs(
    nominal: LoadedNominal, scan: Scan, tolerance: AnyTolerance
) -> dict[str, dict[str, Any]]:
    file = Path(tolerance) if isinstance(tolerance, str | PathLike) else None
    source = scan.source
    return {
        "nominal": {
            **_file(nominal.path), "is": nominal.kind, "unit": nominal.unit,
            "distance_from_file_mm": nominal.error,
        },
        "scan": {
            **_file(source.path), "format": source.format, "unit": source.unit,
            "unit_from": source.unit_from, "points": len(scan.points),
            "triangles": 0 if scan.triangles is None else len(scan.triangles),
            "points_sha256": hashlib.sha256(scan.points.tobytes()).hexdigest(),
        },
        "tolerance": _file(file) if file else {"file": None, "sha256": None},
    }  # fmt: skip


def _file(path: Path | None) -> dict[str, Any]:
    if path is None or not path.is_file():
        return {"file": path.name if path else None, "sha256": None}
    with path.open("rb") as file:
        return {"file": path.name, "sha256": hashlib.file_digest(file, "sha256").hexdigest()}
