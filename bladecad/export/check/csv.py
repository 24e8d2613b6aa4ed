"""deviations.csv: where every point of the scan stands."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterator
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Vector
from bladecad.deviation.inspecting.inspection import Inspection
from bladecad.deviation.inspecting.zones import ZONES
from bladecad.export.digits import decimals, joined, words

COLUMNS: Final = ("x_mm", "y_mm", "z_mm", "deviation_mm", "side", "u", "t", "zone", "section")
DIGITS: Final = 6  # after the point: nanometres
CHUNK: Final = 100_000
BEYOND: Final = "beyond the span"
SIDES: Final = ("pressure", "suction")


def write_csv(inspection: Inspection, path: Path) -> None:
    """Write a row for every point of the scan, in its order.

    Registered coordinates, deviation, side, span and chordwise place of the foot, zone, and the
    nearest section. A point beyond the span has no deviation.
    """
    with path.open("wb") as file:
        file.write((",".join(COLUMNS) + "\n").encode())
        for rows in chunks(inspection):
            file.write(rows)


def chunks(inspection: Inspection) -> Iterator[bytes]:
    """Give the rows of the table, a hundred thousand at a time."""
    feet, T = inspection.feet, inspection.registration.T_nominal_scan
    names = [_quoted(section.name) for section in inspection.sections] or [""]
    nearest = nearest_section(feet.u, np.array([section.u for section in inspection.sections]))
    for first in range(0, len(feet.u), CHUNK):
        part = slice(first, first + CHUNK)
        xyz = inspection.scan.points[part] @ T[:3, :3].T + T[:3, 3]
        deviation = np.where(feet.rim[part], np.nan, feet.distance[part])
        yield joined(
            [
                *(decimals(x, DIGITS) for x in xyz.T),
                decimals(deviation, DIGITS),
                words(SIDES, feet.suction[part].astype(np.intp)),
                decimals(feet.u[part], DIGITS),
                decimals(feet.t[part], DIGITS),
                words((*ZONES, BEYOND), inspection.zone[part]),
                words(names, nearest[part]),
            ]
        )


def nearest_section(u: Vector, stations: Vector) -> NDArray[np.intp]:
    """Return the number of the section nearest in span to every place, (k,)."""
    if not len(stations):
        return np.zeros(len(u), np.intp)
    order = np.argsort(stations)
    middles = 0.5 * (stations[order][1:] + stations[order][:-1])
    return np.asarray(order[np.searchsorted(middles, u)])


def _quoted(name: str) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="").writerow([name, ""])
    return text.getvalue()[:-1]
