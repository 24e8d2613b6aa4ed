"""From a blade to its CAM sheet."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from bladecad.pipeline.clock import Progress

if TYPE_CHECKING:
    from bladecad.cam.sheet import Cutting
    from bladecad.pipeline.blade_file import BladeFile


def write_cam_sheet(
    blade: BladeFile,
    cutting: Cutting,
    folder: str | Path,
    *,
    name: str | None = None,
    force: bool = False,
    progress: Progress = lambda _: None,
) -> tuple[dict[str, Path], dict[str, Any]]:
    """Measure what a blade asks of its cutters, and write it as numbers, table and picture.

    Returns
    -------
    Paths of the files, and the facts in them.

    Raises
    ------
    ExportError
        If the folder is in use or cannot be written; it is then as it was.
    """
    from bladecad.cam.sheet import cam_sheet
    from bladecad.export.cad.cam_files import export_cam

    progress("rulings, cutters, stock")
    sheet = cam_sheet(blade.surface, cutting, machine=blade.machine)
    progress("picture")
    return export_cam(blade.surface, sheet, folder, name=name or blade.name, force=force)
