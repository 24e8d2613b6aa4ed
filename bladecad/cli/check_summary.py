"""A check as lines of text: notes, registration, zones, worst point, verdict."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Final

import typer

from bladecad.cli.summary import WIDTH
from bladecad.cli.words import um
from bladecad.export.check.worst_place import worst_place

if TYPE_CHECKING:
    from bladecad.deviation.inspecting.zones import ZoneResult
    from bladecad.pipeline.check import Check

SAID: Final = 3  # reasons on the last line; the report has all
ZONES: Final = (
    f"{'zone':<{WIDTH + 3}} {'band, um':>14} {'points':>9} {'out':>7} {'lowest':>8} {'highest':>8} "
    f"{'rms':>7} {'measured':>9}"
)


def show(check: Check, files: Mapping[str, Path], *, quiet: bool) -> None:
    """Print what was found; the verdict alone for the quiet."""
    if not quiet:
        for line in (*_notes(check), *_rows(check), *_zones(check), *_last(check, files)):
            typer.echo(line)
    typer.echo(verdict(check))


def verdict(check: Check) -> str:
    """Return the last line, coloured on a terminal."""
    if check.within:
        return typer.style("within tolerance", fg="green", bold=True)
    reasons = list(check.reasons)
    more = f"; and {len(reasons) - SAID} more" if len(reasons) > SAID else ""
    head = typer.style("out of tolerance: ", fg="red", bold=True)
    return head + "; ".join(reasons[:SAID]) + more


def _notes(check: Check) -> Iterator[str]:
    return (f"note: {note}" for note in check.notes)


def _rows(check: Check) -> Iterator[str]:
    found = check.inspection
    nominal, scan = check.inputs["nominal"], check.inputs["scan"]
    yield _row("nominal", f"{nominal['file'] or 'surface'} ({nominal['is']})")
    beyond = f", {found.beyond} beyond the span" if found.beyond else ""
    yield _row("scan", f"{check.name}: {scan['points']} points{beyond}, {scan['format']}")
    fitted = found.registration
    if fitted.kind == "best":
        kept = f", {', '.join(fitted.locked)} kept" if fitted.locked else ""
        turned = f"{math.degrees(fitted.angle):.4g} deg"
        shift = math.hypot(*fitted.shift)
        yield _row("best fit", f"moved {shift:.4g} mm, turned {turned}{kept}, rms {um(fitted.rms)}")
    else:
        yield _row("fit", f"none, as it stands; rms {um(fitted.rms)}")


def _zones(check: Check) -> Iterator[str]:
    yield ZONES
    yield from map(_zone, check.inspection.zones)


def _zone(zone: ZoneResult) -> str:
    band = f"{1e3 * zone.band.lower:+.4g} {1e3 * zone.band.upper:+.4g}"
    numbers = [
        f"{1e3 * value:+{width}.1f}" if math.isfinite(value) else f"{'-':>{width}}"
        for value, width in ((zone.lowest, 8), (zone.highest, 8))
    ]
    rms = f"{1e3 * zone.rms:7.1f}" if math.isfinite(zone.rms) else f"{'-':>7}"
    return (
        f"{zone.name:<{WIDTH + 3}} {band:>14} {zone.points:>9} {zone.out_points:>7} "
        f"{' '.join(numbers)} {rms} {zone.coverage:>8.1%}"
    )


def _last(check: Check, files: Mapping[str, Path]) -> Iterator[str]:
    found = check.inspection
    if found.worst:
        yield _row("worst", worst_place(found.worst[0]))
    if found.referee:
        yield _row(
            "referee",
            f"trimesh, {found.referee.count} points: {um(found.referee.disagreement)} apart, "
            f"{um(found.referee.bound)} allowed",
        )
    yield _row("files", ", ".join(_listed(files)))
    yield _row("in", str(files["report"].parent))


def _listed(files: Mapping[str, Path]) -> Iterator[str]:
    pictures = [file for file in files.values() if file.suffix == ".png"]
    yield from (file.name for file in files.values() if file not in pictures)
    if pictures:
        yield f"{len(pictures)} pictures"


def _row(head: str, text: str) -> str:
    return f"{head:<{WIDTH}} {text}"
