"""Options that are for scans, or for sections, but not for both."""

from __future__ import annotations

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from bladecad.pipeline.scan_settings import ScanSettings

USUAL = {"model": "modal", "spectrum": "shared", "law": "spline", "edges": "file"}


def refuse_for_scans(path: Path, **asked: str) -> None:
    """Refuse what is asked for beside the usual: a scan has one way to be fitted.

    Raises
    ------
    ToleranceError
        If an option makes no sense for a scan.
    """
    for option, value in asked.items():
        if value != USUAL[option]:
            _refuse(f"--{option} {value} is for sections", f"{path.name} holds a scan")


def refuse_for_sections(path: Path, *, axis: Any, **asked: Any) -> None:
    """Refuse what sections cannot be asked for.

    Raises
    ------
    ToleranceError
        If an option makes no sense for sections.
    """
    for option, value in asked.items():
        if value is not None and value is not False:
            _refuse(f"--{option.replace('_', '-')} is for scans", f"{path.name} holds sections")
    if isinstance(axis, tuple):
        said = ",".join(f"{a:g}" for a in axis)
        _refuse(f"--axis {said} is for scans", f"{path.name} holds sections, about x, y or z")


def scan_settings(*, cone: float | None, **asked: Any) -> ScanSettings:
    """Return what is asked for of a scan; what is None is left as usual, `cone` is in degrees."""
    from bladecad.pipeline.scan_settings import ScanSettings

    said = {name: value for name, value in asked.items() if value is not None}
    return ScanSettings(cone=math.radians(cone or 0.0), **said)


def _refuse(option: str, holds: str) -> None:
    from bladecad.errors import ToleranceError

    raise ToleranceError(f"{option}, and {holds}; leave it out")
