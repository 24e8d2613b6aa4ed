"""What the page draws from: the arrays of blade, sections and histogram, as compact text."""

from __future__ import annotations

import base64
import json
from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from bladecad.arrays import Points
from bladecad.deviation.inspecting.inspection import Inspection
from bladecad.deviation.sectioning.section_result import SectionResult
from bladecad.export.check.colours import BAD, BAND, CAP, GOOD, INK, SOFT, STOPS, UNKNOWN
from bladecad.export.check.histogram import Histogram
from bladecad.export.check.mesh import CAP as END
from bladecad.export.check.mesh import Painted
from bladecad.export.check.whiskers import PARTS, Whiskers
from bladecad.export.pictures.view import view_of
from bladecad.surface.loft import SIDES
from bladecad.tolerance import ZONES

TRACK: Final = 160  # points of a section's line on the blade
LIFT: Final = 1.5e-3  # of the size of the blade, that the line stands off it to be seen
RING: Final = 0.02

Data = dict[str, Any]


def page_data(
    inspection: Inspection,
    blade: Painted,
    sections: Sequence[Whiskers],
    histogram: Histogram,
    limit: float,
) -> Data:
    """Return all that the page draws."""
    size = float(np.linalg.norm(np.ptp(blade.vertices, axis=0)))
    return {
        "limit": limit,
        "stops": STOPS,
        "ink": {"line": INK, "soft": SOFT, "band": BAND, "unknown": UNKNOWN, "cap": CAP,
                "good": GOOD, "bad": BAD},
        "meshes": [_mesh(inspection, blade, k, known) for k, known in _parts(blade)],
        "sections": [
            {**_section(one), "track": _track(result, LIFT * size)}
            for one, result in zip(sections, inspection.sections, strict=True)
        ],
        "worst": {
            "at": [packed(column) for column in _lifted(inspection, RING * size).T],
            "deviation": [w.deviation for w in inspection.worst],
            "zone": [w.zone for w in inspection.worst],
            "section": [_named(inspection, w.section) for w in inspection.worst],
        },
        "histogram": _histogram(histogram),
        "views": _views(inspection, blade),
    }  # fmt: skip


def packed(values: ArrayLike, kind: str = "f4") -> Data:
    """Return an array as its type and its bytes in base64, little-endian."""
    array = np.ascontiguousarray(values, dtype=np.dtype(kind).newbyteorder("<"))
    return {"kind": kind, "bytes": base64.b64encode(array.tobytes()).decode()}


def script_json(data: Data) -> str:
    """Return JSON that can stand inside a script element, whatever the names in it say."""
    text = json.dumps(data, separators=(",", ":"), allow_nan=False)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _parts(blade: Painted) -> list[tuple[int, bool]]:
    """Zones that have triangles, and whether those are measured."""
    known = blade.measured & np.isfinite(blade.mean)
    pairs = np.unique(np.column_stack([blade.zone, known]), axis=0)
    return [(int(zone), bool(measured)) for zone, measured in pairs]


def _mesh(inspection: Inspection, blade: Painted, zone: int, known: bool) -> Data:
    at = (blade.zone == zone) & ((blade.measured & np.isfinite(blade.mean)) == known)
    part = blade[at]
    x, y, z = (packed(c) for c in part.vertices.T)
    i, j, k = (packed(c, "i4") for c in part.triangles.T)
    data = {"zone": "" if zone == END else ZONES[zone], "known": known,
            "x": x, "y": y, "z": z, "i": i, "j": j, "k": k}  # fmt: skip
    if known:
        band = inspection.tolerances.zones[ZONES[zone]]
        out = np.sign(part.extreme) * (band.excess(part.extreme) > 0.0)
        data |= {"mean": packed(part.mean), "extreme": packed(part.extreme), "out": packed(out)}
    return data


def _section(w: Whiskers) -> Data:
    (x, y), (nx, ny), (lower, upper) = w.line.T, w.normal.T, w.bounds.T
    columns = {"x": x, "y": y, "nx": nx, "ny": ny, "d": w.deviation, "lower": lower,
               "upper": upper, "t": w.t}  # fmt: skip
    return {
        "name": w.name,
        "u": w.u,
        "worst": w.worst,
        "out": bool(w.worst is not None and w.excess[w.worst] > 0.0),
        "magnification": [w.magnification(part) for part in PARTS],
        "parts": [packed(w.within(part), "i1") for part in PARTS],
        "suction": packed(w.suction, "i1"),
        **{name: packed(column) for name, column in columns.items()},
    }


def _track(section: SectionResult, lift: float) -> list[Data]:
    """The closed line of a section on the blade, x, y and z."""
    some = np.unique(np.linspace(0, len(section.t) - 1, TRACK).astype(int))
    line = (section.outline + lift * section.normal)[np.append(some, 0)]
    return [packed(column) for column in line.T]


def _lifted(inspection: Inspection, lift: float) -> Points:
    """The worst places, off the blade so that a ring about them is seen whole, (k, 3)."""
    index = [w.index for w in inspection.worst]
    feet = inspection.feet
    return np.asarray(feet.foot[index] + lift * feet.normal[index]).reshape(-1, 3)


def _histogram(histogram: Histogram) -> Data:
    return {
        "middles": packed(histogram.middles),
        "width": float(np.diff(histogram.edges)[0]),
        "zones": histogram.zones,
        "counts": [packed(row, "i4") for row in histogram.counts],
        "bands": histogram.bands,
    }


def _views(inspection: Inspection, blade: Painted) -> Data:
    """Up and towards the eye, for each side."""
    surface = inspection.nominal.surface
    views = {side: view_of(surface, side, blade.vertices) for side in SIDES}
    return {f"{side} side": {"up": list(v.rows[1]), "eye": list(v.rows[2])}
            for side, v in views.items()}  # fmt: skip


def _named(inspection: Inspection, name: str) -> int | None:
    """Number of the section of that name."""
    names = [section.name for section in inspection.sections]
    return names.index(name) if name in names else None
