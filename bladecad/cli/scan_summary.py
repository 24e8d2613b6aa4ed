"""What a report says of a scan, as rows of text."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from bladecad.cli.words import um

Report = Mapping[str, Any]
GAPS = 3  # told one by one


def scan_rows(report: Report) -> Iterator[tuple[str, str]]:
    """Return what was taken of the scan."""
    scan, airfoil = report["scan"], report["scan"]["airfoil"]
    mesh = f", {scan['triangles']} triangles" if scan["triangles"] else ""
    yield "scan", f"{report['name']}: {scan['points']} points{mesh}, {report['input']['format']}"
    axis = ", ".join(f"{a:+.4f}" for a in airfoil["axis"])
    yield (
        "airfoil",
        f"{airfoil['points']} points between {airfoil['low_mm']:.3f} and {airfoil['high_mm']:.3f} "
        f"mm, axis {axis}; {airfoil['left']} left, {airfoil['lonely']} lonely ones dropped",
    )
    if scan["partial"]:
        yield "partial", _partial(scan)


def _partial(scan: Report) -> str:
    """What was not built or not measured, in a line."""
    partial, said = scan["partial"], []
    if partial["blades"]:
        said.append(f"one of {len(partial['blades'])} blades of the scan")
    beyond = partial["below_mm"] + partial["above_mm"]
    if beyond:
        said.append(f"{beyond:.4g} mm of its height left, with one side alone")
    if scan["gaps"]:
        said.append(f"{1.0 - scan['supported']:.1%} of the surface not measured")
    return "; ".join(said)


def fit_rows(report: Report) -> Iterator[tuple[str, str]]:
    """Return how the surface lies among the points, and where there are none."""
    fit, found, allowed = report["scan"]["fit"], report["scan"]["systematic"], report["verdict"]
    yield (
        "noise",
        f"sigma {um(fit['noise_mm'])}; the fit leaves {fit['excess']:.3f} times that, neighbours "
        f"correlate by {fit['correlation']:.3f}; {fit['set_aside']} outliers set aside",
    )
    yield "spans", f"{fit['spans']}: {fit['criterion']}"
    yield (
        "systematic",
        f"max {um(found['largest_mm'])} in the mean of a place, {um(allowed['tolerance_mm'])} "
        f"allowed; {found['cells']} places",
    )
    counted = report["scan"]["table"][0]
    yield (
        "that count",
        f"max {um(counted['max_mm'])}, p99 {um(counted['p99_mm'])}, rms {um(counted['rms_mm'])}, "
        f"mean {1e3 * counted['mean_mm']:+.2g} um, {counted['points']} points",
    )
    yield from _worst(report["scan"]["worst"])
    yield from _gaps(report["scan"]["gaps"])


def _worst(places: list[Report]) -> Iterator[tuple[str, str]]:
    for one in places[:1]:
        why = f": {one['why']}" if one["why"] else ""
        yield (
            "worst",
            f"{1e3 * one['deviation_mm']:+.3g} um on the {one['side']} side, u = {one['u']:.3f}, "
            f"t = {one['t']:.3f}{why}",
        )


def _gaps(gaps: list[Report]) -> Iterator[tuple[str, str]]:
    for number, gap in enumerate(gaps[:GAPS], 1):
        (u0, u1), (t0, t1) = gap["u"], gap["t"]
        yield (
            f"gap {number}",
            f"{gap['area_mm2']:.3g} mm2 of the {gap['side']} side without a point, "
            f"u {u0:.2f} .. {u1:.2f}, t {t0:.2f} .. {t1:.2f}: not measured",
        )
    if len(gaps) > GAPS:
        area = sum(gap["area_mm2"] for gap in gaps[GAPS:])
        yield "", f"and {len(gaps) - GAPS} more, {area:.3g} mm2"
