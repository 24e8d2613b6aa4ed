"""What the report says of a scan: what was taken, how the surface lies in it, what is missing."""

from __future__ import annotations

from typing import Any

import numpy as np

from bladecad.export.reports.report_rows import row_numbers
from bladecad.scans.finding.airfoil import Airfoil
from bladecad.scans.finding.partial import Partial
from bladecad.scans.fitting.whole import WholeFit
from bladecad.scans.judging.scanned import Scanned
from bladecad.scans.judging.support import Gap
from bladecad.scans.judging.systematic import FEWEST, Place, Systematic
from bladecad.scans.judging.worst import WorstPlace

Report = dict[str, Any]


def scan_numbers(scanned: Scanned) -> Report:
    """Return what is known of a blade that came from a scan, for its report."""
    scan = scanned.airfoil.scan
    return {
        "points": len(scan.points),
        "triangles": 0 if scan.triangles is None else len(scan.triangles),
        "partial": _partial(scanned.airfoil.partial),
        "airfoil": _airfoil(scanned.airfoil),
        "fit": _fit(scanned.whole),
        "systematic": _systematic(scanned.systematic),
        "table": [row_numbers(row) for row in scanned.table()],
        "worst": [_worst(one) for one in scanned.worst],
        "gaps": [_gap(one) for one in scanned.gaps],
        "supported": 1.0 - _missing(scanned),
        "transform": scanned.transform,
    }


def _partial(partial: Partial | None) -> Report | None:
    if partial is None:
        return None
    sided = partial.sided
    return {
        "blades": [{"points": one.points, "centre_mm": one.centre} for one in partial.blades],
        "below_mm": sided.below,
        "above_mm": sided.above,
        "one_side_missing": sided.share,
        "notes": list(partial.notes),
    }


def _airfoil(airfoil: Airfoil) -> Report:
    height, taken = airfoil.height, int(airfoil.taken.sum())
    return {
        "axis": airfoil.axis,
        "along": height.kind,
        "half_angle_deg": float(np.degrees(height.half_angle)),
        "low_mm": airfoil.low,
        "high_mm": airfoil.high,
        "points": taken,
        "lonely": int(airfoil.lonely.sum()),
        "left": len(airfoil.taken) - taken - int(airfoil.lonely.sum()),
        "notes": list(airfoil.notes),
    }


def _fit(whole: WholeFit) -> Report:
    aside = whole.weight <= 0.0
    return {
        "noise_mm": whole.noise,
        "excess": whole.excess,
        "correlation": whole.correlation,
        "criterion": whole.criterion,
        "spans": len(whole.surface.span) - 1,
        "passes": whole.passes,
        "set_aside": int(aside.sum()),
        "beyond": int(whole.feet.rim.sum()),
    }


def _systematic(found: Systematic) -> Report:
    return {
        "largest_mm": found.largest,
        "cells": found.cells,
        "points_a_cell": FEWEST,
        "share": found.share,
        "worst": None if found.worst is None else _place(found.worst),
    }


def _place(place: Place) -> Report:
    return {
        "side": place.side,
        "u": place.u,
        "t": place.t,
        "mean_mm": place.mean,
        "error_mm": place.error,
        "scatter_mm": place.scatter,
        "points": place.points,
    }


def _worst(one: WorstPlace) -> Report:
    place = one.place
    return {
        "deviation_mm": place.deviation,
        "zone": place.zone,
        "side": place.side,
        "u": place.u,
        "t": place.t,
        "at_mm": place.point,
        "mean_mm": one.mean,
        "scatter_mm": one.scatter,
        "points": one.points,
        "set_aside": one.set_aside,
        "why": one.why,
    }


def _gap(gap: Gap) -> Report:
    return {
        "side": gap.side,
        "u": list(gap.u),
        "t": list(gap.t),
        "area_mm2": gap.area,
        "share": gap.share,
        "centre_mm": gap.centre,
    }


def _missing(scanned: Scanned) -> float:
    """Share of the blade's area that lies in gaps: both sides are about as large."""
    return 0.5 * sum(gap.share for gap in scanned.gaps)
