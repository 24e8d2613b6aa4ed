"""Hub and shroud from a file: a table of both, or what stands beside sections."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from bladecad.data.read import read_sections
from bladecad.data.sections import MM_PER, Axis, Row, Unit
from bladecad.data.table import read_table
from bladecad.data.text import read_text
from bladecad.errors import DataError


def walls_of(path: Path, *, unit: Unit | None = None, axis: Axis | None = None) -> Row:
    """Read hub, shroud and, where it is said, the blade count.

    Parameters
    ----------
    path : path
        A `.csv` with columns `curve,z_mm,r_mm`, curve being `hub` or `shroud`; else any file of
        sections that knows its row: TurboGrid `.inf` or `.curve`, `.geomTurbo`.
    unit, axis
        As `read_sections` takes them.

    Raises
    ------
    DataError
        If the file cannot be read, or says nothing of hub and shroud.
    """
    row = _table(path, unit) if _is_table(path) else read_sections(path, unit=unit, axis=axis).row
    for name, curve in (("hub", row.hub), ("shroud", row.shroud)):
        if not len(curve):
            raise DataError(
                f"{path.name} has no {name}; give a .inf, a .geomTurbo, or a table "
                "with columns curve,z_mm,r_mm"
            )
    return row


def _is_table(path: Path) -> bool:
    if path.suffix.lower() != ".csv" or not path.is_file():
        return False
    lines = (line.strip().lower() for line in read_text(path).lines)
    head = next((line for line in lines if line and not line.startswith("#")), "")
    return head.split(",")[0].strip() == "curve"


def _table(path: Path, unit: Unit | None) -> Row:
    table = read_table(read_text(path))
    scale = MM_PER[unit or table.unit("z", "r") or "mm"]
    zr, curve = table.values("z", "r") * scale, np.array(table.labels("curve"))
    return Row(None, zr[curve == "hub"], zr[curve == "shroud"])
