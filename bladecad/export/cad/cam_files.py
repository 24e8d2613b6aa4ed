"""The files of a CAM sheet: numbers, a table along the span, a picture."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Final

from bladecad.cam.sheet import CamSheet
from bladecad.export.cad.cam_facts import cam_csv, cam_facts
from bladecad.export.stage import staged
from bladecad.export.text import write_json
from bladecad.surface.blade import BladeSurface

FILES: Final = {"facts": "cam.json", "table": "cam.csv", "picture": "cam.png"}
DIGITS: Final = 9


def export_cam(
    surface: BladeSurface,
    sheet: CamSheet,
    folder: str | os.PathLike[str],
    *,
    name: str,
    force: bool = False,
) -> tuple[dict[str, Path], dict[str, Any]]:
    """Write cam.json, cam.csv and cam.png, together or not at all.

    Parameters
    ----------
    surface : BladeSurface
        The blade that the sheet is about.
    sheet : CamSheet
    folder : path
        New or empty; made where it is missing.
    name : str
        Of the blade.
    force : bool
        Replace files of an earlier sheet.

    Returns
    -------
    "facts", "table" and "picture" to their paths, and the facts themselves.

    Raises
    ------
    ExportError
        If the folder is in use or cannot be written; it is then as it was.
    """
    from bladecad.export.cad.cam_picture import draw_cam

    facts = cam_facts(sheet, name)
    with staged(folder, force=force, report=FILES["facts"]) as stage:
        write_json(facts, stage / FILES["facts"], digits=DIGITS)
        (stage / FILES["table"]).write_text(cam_csv(facts), encoding="utf-8")
        draw_cam(surface, sheet, stage / FILES["picture"], name=name)
    return {key: Path(folder) / file for key, file in FILES.items()}, facts
