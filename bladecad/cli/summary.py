"""A report as lines of text: what is printed is what stands in report.json."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import typer

from bladecad.cli.scan_summary import fit_rows, scan_rows
from bladecad.cli.words import um

Report = Mapping[str, Any]
WIDTH = 11


def show(report: Report, *, quiet: bool, folder: Path | None = None) -> None:
    """Print notes, numbers and the verdict; the verdict alone for the quiet."""
    if not quiet:
        for line in (*notes(report), *table(report)):
            typer.echo(line)
        if folder is not None:
            typer.echo(f"{'in':<{WIDTH}} {folder}")
    typer.echo(verdict(report))


def notes(report: Report) -> list[str]:
    """Return what was guessed, repaired or set aside, one line each."""
    aside = [
        f'section "{one["section"]}", point {one["point"]}: {one["offset_mm"]:+.3g} mm off the '
        "line of its neighbours, set aside"
        for one in report["misprints"]
    ]
    odd = report.get("odd_sections", [])
    return [f"note: {note}" for note in (*report["input"]["notes"], *aside, *odd)]


def table(report: Report) -> list[str]:
    """Return the numbers, one line each, as far as the report has them."""
    return [f"{head:<{WIDTH}} {text}" for head, text in _rows(report)]


def verdict(report: Report) -> str:
    """Return the last line, coloured on a terminal."""
    found = report["verdict"]
    partial = found.get("partial", False)
    if found["within"]:
        said = f"within {um(found['tolerance_mm'])}"
        if partial:
            return typer.style(f"partial blade, {said} where it was measured", fg="yellow")
        return typer.style(said, fg="green", bold=True)
    said = "partial blade, out of tolerance: " if partial else "out of tolerance: "
    return typer.style(said, fg="red", bold=True) + "; ".join(found["reasons"])


def _rows(report: Report) -> Iterator[tuple[str, str]]:
    yield from scan_rows(report) if "scan" in report else _blade_rows(report)
    yield from _order_rows(report["fit"])
    yield from fit_rows(report) if "scan" in report else _fit_rows(report["fit"])
    if "solid" in report:
        yield from _surface_rows(report)
        yield from _solid_rows(report)
    for i, file in enumerate(report["files"]):
        yield "" if i else "files", f"{file['file']} ({_size(file['bytes'])})"


def _blade_rows(report: Report) -> Iterator[tuple[str, str]]:
    read = report["input"]
    points = sum(section["points"] for section in read["sections"])
    yield (
        "blade",
        f"{report['name']}: {len(read['sections'])} sections, {points} points, {read['format']}",
    )


def _order_rows(fit: Report) -> Iterator[tuple[str, str]]:
    order = fit["order"]
    if order:
        restarts = f", {order['knots']} knots" if order["knots"] else ""
        pairs = f"{order['le']} LE pairs, {order['te']} TE pairs, core degree {order['degree']}"
        yield "order", f"{fit['model']}: {pairs}{restarts}"
    else:
        yield "model", fit["model"]


def _fit_rows(fit: Report) -> Iterator[tuple[str, str]]:
    worst = fit["worst"]
    yield (
        "fit",
        f"max {um(fit['max_mm'])}, rms {um(fit['rms_mm'])}, "
        f"{um(fit['tolerance_mm'])} allowed, margin {fit['margin']:.2g}; worst on the "
        f'{worst["side"]} side of section "{worst["section"]}" at t = {worst["t"]:.3f}',
    )
    if fit["left_out"]:
        left_out = fit["left_out"]
        yield (
            "left out",
            f"max {um(left_out['max_mm'])}, rms {um(left_out['rms_mm'])} where every second point "
            "was left out and predicted",
        )


def _surface_rows(report: Report) -> Iterator[tuple[str, str]]:
    between = report["surface"]["section_left_out_mm"]
    if between is not None:
        yield "between", f"max {um(between)} where a section was left out and predicted"
    deviation = report["deviation"]
    total, referee = deviation["table"][0], deviation["referee"]
    yield (
        "deviation",
        f"max {um(total['max_mm'])}, p99 {um(total['p99_mm'])}, rms {um(total['rms_mm'])}, "
        f"mean {1e3 * total['mean_mm']:+.2g} um, {total['points']} points",
    )
    yield (
        "referee",
        f"trimesh, {referee['points']} points: {um(referee['disagreement_mm'])} apart, "
        f"{um(referee['bound_mm'])} allowed",
    )


def _solid_rows(report: Report) -> Iterator[tuple[str, str]]:
    solid, mesh = report["solid"], report["mesh"]
    counts = "/".join(str(count) for count in solid["vertices_edges_faces"])
    yield "B-rep to S", f"max {um(solid['to_surface_mm'])}"
    yield (
        "witnesses",
        f"kernel {'valid' if solid['valid'] else 'invalid'}; V/E/F {counts}, Euler "
        f"{solid['euler']}; volume {solid['volume_mm3']:.8g} mm3, quadrature "
        f"{solid['volume_error']:.1g} apart",
    )
    triangles = sum(mesh["triangles"].values())
    yield "triangles", f"{triangles}, chord error {um(mesh['chord_error_mm'])}, watertight"


def _size(size: int) -> str:
    return f"{size / 1000:.0f} kB" if size < 1e6 else f"{size / 1e6:.1f} MB"
