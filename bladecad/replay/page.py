"""The page that goes with the figures: what the paper says, what was measured, why they differ.

The prose is in `page.md`; here are its numbers.
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np

from bladecad.replay.curves import distance
from bladecad.replay.ink import millimetres as mm
from bladecad.replay.ladder import SEGMENTS
from bladecad.replay.plain import SUBSTEPS
from bladecad.replay.results import BEST, Results
from bladecad.replay.subject import Region
from bladecad.replay.surfaces import away_from_blend, three_surfaces
from bladecad.replay.tables import (
    bars_table,
    blades_table,
    ladder_table,
    laws_table,
    moves_table,
    plain_table,
)

PROSE: Final = Path(__file__).with_name("page.md")
AS_MEASURED: Final = "Sections and points are those of the file."
LAID_OUT: Final = """\
The blade is NASA Rotor 37 in its running shape (`fixtures/rotor37`), laid out as the paper's. Its
13 sections are made dense by their periodic cubic splines and taken at 71 parameters a side, as
dense towards the edges as the measured points; along the span the C2 spline through them gives 15
at equal distances; and all is scaled about the origin until hub and tip are 100 mm apart. No fit
takes part in this: the result is data, 140 points a loop."""


def page(results: Results, images: str = "") -> str:
    """Write the page, Markdown; `images` goes before the name of every picture."""
    text = PROSE.read_text(encoding="utf-8").format(**_facts(results), **_tables(results))
    return text.replace("](@", f"]({images}")


def _facts(results: Results) -> dict[str, str]:
    points = results.subjects["full"].suction.points
    surfaces = [mm(away_from_blend(results, *surface).max()) for surface in three_surfaces(results)]
    return {
        "blade": results.blade.name,
        "sections": str(len(points)),
        "points": str(points.shape[1]),
        "length": mm(results.length),
        "laid": LAID_OUT if results.blade.points else AS_MEASURED,
        "core_gaps": _gaps(results, "core"),
        "full_gaps": _gaps(results, "full"),
        "substeps": str(SUBSTEPS),
        "places": str(len(results.paper["core"].u)),
        **dict(zip(("core_surface", "full_surface", "modal_surface"), surfaces, strict=True)),
        "order": str(BEST),
        "radius": mm(float(np.linalg.norm(points, axis=2).mean())),
        "segments": str(SEGMENTS),
        "core_rates": _rates(results, "core"),
        "full_rates": _rates(results, "full"),
    }


def _tables(results: Results) -> dict[str, str]:
    return {
        "plain": plain_table(results),
        "absolute": bars_table(results, relative=False),
        "relative": bars_table(results, relative=True),
        "ladder": ladder_table(results),
        "blades": blades_table(results),
        "laws": laws_table(results),
        "moves": moves_table(results),
    }


def _gaps(results: Results, region: Region) -> str:
    points = results.subjects[region].suction.points
    gaps = distance(points[:, 1:], points[:, :-1])
    return f"{mm(gaps.min())} to {mm(gaps.max())}"


def _rates(results: Results, region: Region) -> str:
    largest = np.linalg.eigvals(results.paper[region].fields).real.max(axis=1)
    return f"{mm(largest[0])} to {mm(largest[-1])}"
