"""From a scan to a measured solid: the airfoil found, sliced, fitted to all its points."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np

from bladecad.arrays import Array
from bladecad.curves.sides import BladeLines
from bladecad.data.read_scan import read_scan
from bladecad.data.scan import Scan
from bladecad.data.sections import Axis, Sections
from bladecad.errors import DataError, GeometryError
from bladecad.pipeline.body import body_of
from bladecad.pipeline.clock import Clock, Progress
from bladecad.pipeline.scan_build import ScanBuild
from bladecad.pipeline.scan_named import named
from bladecad.pipeline.scan_settings import ScanSettings
from bladecad.scans.blade_frame import blade_frame
from bladecad.scans.finding.airfoil import Airfoil, find_airfoil
from bladecad.scans.finding.denser import denser, is_coarse
from bladecad.scans.fitting.moved_whole import moved_whole
from bladecad.scans.fitting.whole import WholeFit, fit_scan
from bladecad.scans.judging.scanned import Scanned, deviation_of_scan
from bladecad.scans.judging.support import find_gaps
from bladecad.scans.judging.systematic import systematic
from bladecad.scans.judging.worst import worst_of_scan
from bladecad.scans.moved import moved_sections
from bladecad.scans.slicing.parted import parted
from bladecad.scans.slicing.slices import slice_airfoil

USUAL: Final = ScanSettings()
MACHINE: Final[Axis] = "x"  # in the frame of the blade


def build_scan(
    path: str | Path,
    settings: ScanSettings = USUAL,
    *,
    progress: Progress = lambda _: None,
) -> ScanBuild:
    """Turn a scan into a solid blade, and measure it, before anything is written.

    Parameters
    ----------
    path : path
        A mesh or a cloud, any format that `read_scan` reads.
    settings : ScanSettings
    progress : callable
        Told the name of each step as it begins.

    Raises
    ------
    DataError
        If the file cannot be read, or is no scan of one blade.
    FitError
        If no surface follows the scan.
    GeometryError
        If the solid is not what it must be.
    """
    clock = Clock(progress)
    with clock.step("read the scan"):
        scan = read_scan(path, unit=settings.unit)
    with clock.step("find the airfoil"):
        airfoil = airfoil_of(scan, settings)
    with clock.step("slice"):
        sections, lines = slices_of(airfoil, settings)
    with clock.step("fit the surface"):
        with _said_of(scan, "no surface follows the points: "):
            whole = fit_scan(
                airfoil.points, lines, airfoil.axis, tolerance=settings.tolerance,
                order=settings.order, progress=progress,
            )  # fmt: skip
        move = blade_frame(whole.surface, airfoil.axis) if settings.align else np.eye(4)
        if settings.align:
            whole, sections = moved_whole(whole, move), moved_sections(sections, move, MACHINE)
    with _said_of(scan):
        body = body_of(
            whole.surface, tolerance=settings.tolerance, chord_error=settings.chord_error,
            clock=clock,
        )  # fmt: skip
    with clock.step("deviation"):
        scanned = _scanned(airfoil, whole, move)
        deviation = deviation_of_scan(airfoil, whole, body.mesh)
    return ScanBuild(
        settings, sections, replace(whole.fit.lines, notes=lines.notes), scanned, body, deviation,
        clock.seconds,
    )  # fmt: skip


def sections_of_scan(
    path: str | Path, settings: ScanSettings = USUAL, *, progress: Progress = lambda _: None
) -> Sections:
    """Cut a scan into sections, hub to tip, with edges and sides named.

    Raises
    ------
    DataError
        If the file cannot be read, or is no scan of one blade.
    """
    clock = Clock(progress)
    with clock.step("read the scan"):
        scan = read_scan(path, unit=settings.unit)
    with clock.step("find the airfoil"):
        airfoil = airfoil_of(scan, settings)
    with clock.step("slice"):
        sections, lines = slices_of(airfoil, settings)
    return named(sections, lines)


def airfoil_of(scan: Scan, settings: ScanSettings) -> Airfoil:
    """Find what of the scan is airfoil, as the settings say."""
    with _said_of(scan):
        found = _found(scan, settings)
        if not is_coarse(found):
            return found
        again = _found(denser(found), settings)
        left = found.partial.notes if found.partial else ()
        return replace(again, partial=found.partial, notes=(*left, *again.notes))


def _found(scan: Scan, settings: ScanSettings) -> Airfoil:
    return find_airfoil(
        scan, axis=settings.direction, span=settings.span, height=settings.height,
        allow_partial=settings.allow_partial,
    )  # fmt: skip


def slices_of(airfoil: Airfoil, settings: ScanSettings) -> tuple[Sections, BladeLines]:
    """Cut the airfoil into sections and these into sides; their notes are all that was said."""
    with _said_of(airfoil.scan):
        cut = slice_airfoil(airfoil, settings.stations)
        sections, lines = parted(airfoil, cut, le=settings.le, suction=settings.suction)
    source = airfoil.scan.source
    said = (*source.notes, *airfoil.notes, *sections.source.notes)
    kept = replace(
        source, axis=sections.source.axis, axis_from=sections.source.axis_from,
        notes=tuple(dict.fromkeys(said)),
    )  # fmt: skip
    return replace(sections, source=kept), lines


@contextmanager
def _said_of(scan: Scan, before: str = "") -> Iterator[None]:
    """Let a refusal begin with the name of the file; with `before`, say what came of it."""
    name = scan.source.path.name if scan.source.path else "the scan"
    try:
        yield
    except (DataError, GeometryError) as error:
        said = f"{before}{error}"
        raise type(error)(said if name in said else f"{name}: {said}") from error


def _scanned(airfoil: Airfoil, whole: WholeFit, move: Array) -> Scanned:
    """What points say of the surface: outliers cannot fill a gap."""
    gaps = find_gaps(whole.surface, whole.feet[whole.weight > 0.0])
    found = systematic(whole.feet, whole.weight)
    worst = worst_of_scan(whole.feet, whole.weight, gaps, whole.noise)
    return Scanned(airfoil, whole, gaps, found, worst, move)
