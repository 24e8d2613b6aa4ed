"""The tables of the page, in Markdown."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from bladecad.replay.draw_errors import errors
from bladecad.replay.ink import millimetres as mm
from bladecad.replay.ladder import RUNGS, SEGMENTS
from bladecad.replay.results import Results
from bladecad.replay.subject import REGIONS

ROUNDING = 1e-5  # degrees: a crease below it is none
SHOWN = ("arc length", "second order", "on the trajectory", f"{SEGMENTS} segments")


def table(header: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """One Markdown table."""
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def plain_table(results: Results) -> str:
    """Figure 2: the paper's fit."""
    header = ("", "steps", "largest, mm", "median line, mm", "Runge-Kutta")
    rows = [
        (
            p.region,
            p.spacing,
            mm(p.absolute.max()),
            mm(np.median(p.absolute)),
            _power(p.runge_kutta),
        )
        for p in results.plain
    ]
    return table(header, rows)


def bars_table(results: Results, *, relative: bool) -> str:
    """Figures 4 and 5: the best line and the worst."""
    rows = [
        (region, name, mm(e.min()), mm(e.max()))
        for region in REGIONS
        for name, e in errors(results, region, relative=relative).items()
        if name != "modal" or region == "full"
    ]
    return table(("", "steps", "best line", "worst line"), rows)


def ladder_table(results: Results) -> str:
    """Every rung on the replayed blade, core and full."""
    header = ("", "model", "coefficients", "at the points, mm", "between, mm", "rms, mm",
              "median line, mm")  # fmt: skip
    own = [step for step in results.ladder if step.blade == results.blade.name]
    return table(header, [(s.region, s.rung, str(s.coefficients), *map(mm, s.score)) for s in own])


def blades_table(results: Results) -> str:
    """Some rungs on all blades."""
    names = [name for name in RUNGS if name in SHOWN or "18" in name or "34" in name]
    found = {(s.blade, s.rung): s.score.largest for s in results.ladder if s.region == "full"}
    blades = dict.fromkeys(step.blade for step in results.ladder)
    return table(("blade", *names), [(b, *(mm(found[b, n]) for n in names)) for b in blades])


def laws_table(results: Results) -> str:
    """Crease and leave-one-out error of both laws."""
    header = ("law", "largest crease, degrees", "median", "section left out, largest, mm", "median")
    rows = [
        (law, *map(_degrees, _spread(s.crease)), *map(mm, _spread(s.left_out)))
        for law, s in results.laws.items()
    ]
    return table(header, rows)


def moves_table(results: Results) -> str:
    """Every model here and there."""
    header = ("", "model", "here, mm", "moved, mm", "median line, mm", "moved, mm", "cares?")
    rows = [
        (m.region, m.rung, mm(m.here.largest), mm(m.there.largest), mm(m.here.median),
         mm(m.there.median), "no" if m.stays else "yes")
        for m in results.moves
    ]  # fmt: skip
    return table(header, rows)


def _spread(values: np.ndarray[tuple[int], np.dtype[np.float64]]) -> tuple[float, float]:
    return float(np.nanmax(values, initial=0.0)), float(
        np.nanmedian(values)
    ) if values.size else 0.0


def _degrees(value: float) -> str:
    return mm(value) if value > ROUNDING else f"below {ROUNDING:.0e}"


def _power(value: float) -> str:
    return f"1e{int(np.ceil(np.log10(value)))}" if value > 0 else "0"
