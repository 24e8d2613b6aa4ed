"""A line of a table of deviations, as it stands in a report."""

from __future__ import annotations

from typing import Any

from bladecad.deviation.inspecting.measure import Row


def row_numbers(row: Row) -> dict[str, Any]:
    """Return name, points and lengths, in mm."""
    return {
        "of": row.name,
        "points": row.points,
        "max_mm": row.largest,
        "p99_mm": row.p99,
        "rms_mm": row.rms,
        "mean_mm": row.mean,
    }
