"""The CAM sheet as numbers under names: what stands in cam.json, in the table, and is printed."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

import numpy as np

from bladecad.arrays import Vector
from bladecad.cam.cutter import Passes
from bladecad.cam.edges import Edge
from bladecad.cam.flank import Flank
from bladecad.cam.sheet import CamSheet, Spot
from bladecad.cam.thickness import Thickness

SCHEMA: Final = "bladecad-cam/1"
COLUMNS: Final = ("u", "leading_edge_mm", "trailing_edge_mm", "thickness_mm")


def cam_facts(sheet: CamSheet, name: str) -> dict[str, Any]:
    """Return the sheet as plain values, ready for JSON; lengths in mm, angles in degrees."""
    cut = sheet.cutting
    return {
        "schema": SCHEMA,
        "name": name,
        "cutting": {"ball_radius_mm": cut.ball, "scallop_mm": cut.scallop,
                    "tolerance_mm": cut.tolerance},
        "flank_milling": {
            "possible": sheet.flank_millable,
            "error_mm": sheet.flank_error,
            "fit": "least squares along the normal",
            **{side.side: _flank(side, cut.ball) for side in sheet.flanks},
        },
        "least_concave_radius": _spot(sheet.concave),
        "least_convex_radius": _spot(sheet.convex),
        "largest_ball_radius": _spot(sheet.ball),
        "edges": {"leading": _edge(sheet.le, sheet.u),
                  "trailing": _edge(sheet.te, sheet.u)},
        "passes": {"along_chord": _passes(sheet.chordwise, "u"),
                   "along_span": _passes(sheet.spanwise, "t")},
        "thickness": _thickness(sheet.thickness),
        "stock": _stock(sheet),
        "rows": [dict(zip(COLUMNS, row, strict=True)) for row in _rows(sheet)],
    }  # fmt: skip


def cam_csv(facts: dict[str, Any]) -> str:
    """Return the rows along the span as comma-separated values."""
    lines = [",".join(f"{row[key]:.6g}" for key in COLUMNS) for row in facts["rows"]]
    return "\n".join([",".join(COLUMNS), *lines]) + "\n"


def cam_words(facts: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """Say the sheet in lines: a head and a text each."""
    for side in ("suction", "pressure"):
        one = facts["flank_milling"][side]
        yield (
            f"{side} side",
            (
                f"{one['largest_mm']:.3g} mm off the best ruled surface at most, rms "
                f"{one['rms_mm']:.3g} mm; normal twists {one['twist_deg']:.3g} deg along a ruling"
            ),
        )
    for head, key in (("concave", "least_concave_radius"), ("convex", "least_convex_radius"),
                      ("largest ball", "largest_ball_radius")):  # fmt: skip
        yield head, _said(facts[key])
    for edge in ("leading", "trailing"):
        yield f"{edge} edge", _edge_said(facts["edges"][edge])
    cut = facts["cutting"]
    ball = f"{1e3 * cut['scallop_mm']:.3g} um, ball of radius {cut['ball_radius_mm']:g} mm"
    for head, key in (("along chord", "along_chord"), ("along span", "along_span")):
        one = facts["passes"][key]
        apart = f"{one['narrowest_mm']:.3g} to {one['widest_mm']:.3g} mm are allowed between"
        yield head, f"{one['count']} passes, {apart}, for scallops of {ball}"
    thick = facts["thickness"]
    yield (
        "thickness",
        " to ".join(
            f"{one['mm']:.4g} mm (u = {one['u']:.3f}, t = {one['t']:.3f})"
            for one in (thick["thinnest"], thick["thickest"])
        ),
    )
    yield from _stock_words(facts["stock"])


def _flank(side: Flank, ball: float) -> dict[str, Any]:
    counted = np.where(side.counted, np.abs(side.deviation), 0.0)
    i, j = np.unravel_index(int(counted.argmax()), counted.shape)
    return {
        "largest_mm": side.largest,
        "at": {"v": side.v[i], "t": side.t[j]},
        "rms_mm": side.rms,
        "twist_deg": float(np.degrees(side.twist.max())),
        "overcut_mm": side.overcut(ball),
    }


def _spot(spot: Spot) -> dict[str, Any]:
    return {"mm": spot.value, "place": spot.place}


def _edge(edge: Edge, u: Vector) -> dict[str, Any]:
    low, high = int(edge.size.argmin()), int(edge.size.argmax())
    return {
        "kind": edge.kind,
        "least_mm": edge.size[low], "least_at_u": u[low],
        "largest_mm": edge.size[high], "largest_at_u": u[high],
    }  # fmt: skip


def _passes(passes: Passes, name: str) -> dict[str, Any]:
    apart = {"narrowest_mm": passes.narrowest, "widest_mm": passes.widest}
    return {"count": len(passes.at), **apart, name: passes.at}


def _thickness(found: Thickness) -> dict[str, Any]:
    return {
        name: dict(zip(("mm", "u", "t"), spot, strict=True))
        for name, spot in (("thinnest", found.thinnest), ("thickest", found.thickest))
    }


def _stock(sheet: CamSheet) -> dict[str, Any]:
    stock = sheet.stock
    return {
        "box_low_mm": stock.low,
        "box_high_mm": stock.high,
        "bar_diameter_mm": stock.bar_diameter,
        "bar_length_mm": stock.bar_length,
        "ring_radius_mm": stock.ring,
        "axial_mm": stock.axial,
        "sector_deg": float(np.degrees(stock.sector)),
    }


def _rows(sheet: CamSheet) -> Iterator[tuple[float, ...]]:
    columns = (sheet.u, sheet.le.size, sheet.te.size, sheet.thickness.of_sections)
    for row in zip(*columns, strict=True):
        yield tuple(map(float, row))


def _said(spot: dict[str, Any]) -> str:
    if not np.isfinite(spot["mm"]):
        return "none, any ball reaches everything"
    return f"{spot['mm']:.4g} mm, {spot['place']}"


def _edge_said(edge: dict[str, Any]) -> str:
    if edge["kind"] == "sharp":
        return "sharp"
    what = "radius" if edge["kind"] == "round" else "cut off, width"
    return (
        f"{what} {edge['least_mm']:.4g} mm (u = {edge['least_at_u']:.3f}) to "
        f"{edge['largest_mm']:.4g} mm (u = {edge['largest_at_u']:.3f})"
    )


def _stock_words(stock: dict[str, Any]) -> Iterator[tuple[str, str]]:
    box = np.array(stock["box_high_mm"]) - np.array(stock["box_low_mm"])
    yield "box", " x ".join(f"{side:.2f}" for side in box) + " mm along x, y and z"
    yield (
        "bar",
        (
            f"{stock['bar_diameter_mm']:.2f} mm across, {stock['bar_length_mm']:.2f} mm along the "
            "stacking axis"
        ),
    )
    inner, outer = stock["ring_radius_mm"]
    first, last = stock["axial_mm"]
    yield (
        "ring",
        (
            f"radius {inner:.2f} to {outer:.2f} mm, {first:.2f} to {last:.2f} mm along the machine "
            f"axis, {stock['sector_deg']:.2f} deg about it"
        ),
    )
