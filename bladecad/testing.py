"""Checks of blades in a test suite: one line that fails when a blade drifts.

    from bladecad.testing import assert_within

    def test_the_blade_is_still_the_blade(tmp_path):
        assert_within("blade.json", "scan.ply", 0.05, artefact=tmp_path / "check")

or, with the fixture that comes with bladecad and keeps the report in pytest's own folder:

    def test_the_blade_is_still_the_blade(blade_check):
        blade_check("blade.json", "scan.ply", 0.05)
"""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from bladecad.deviation.registering.registration import Kind
    from bladecad.pipeline.check import AnyNominal, AnyScan, AnyTolerance, Check, CheckSettings

SAID: Final = 5  # reasons in a message; the report has all


def assert_within(
    nominal: AnyNominal,
    scan: AnyScan,
    tolerance: AnyTolerance,
    *,
    fit: Kind = "best",
    settings: CheckSettings | None = None,
    artefact: str | os.PathLike[str] | None = None,
    name: str | None = None,
) -> Check:
    """Fail unless a scan lies within tolerance of its nominal.

    Parameters
    ----------
    nominal : path, BladeSurface
        A model file, sections, a STEP or a mesh; or a surface that is at hand.
    scan : path, Scan or (k, 3) float, mm
    tolerance : path, Tolerances or float
        A tolerance file, or the same +/- band in mm for all zones.
    fit : {"best", "none"}
        Best fit from any pose, or the scan as it stands.
    settings : CheckSettings, optional
        All further settings; instead of `fit`.
    artefact : path, optional
        Folder for the report, whatever the verdict; replaced where it holds an earlier one.
        Without it the report of a failure is kept in a new temporary folder.
    name : str, optional
        Of the blade in the report.

    Returns
    -------
    Check
        All that was measured.

    Raises
    ------
    AssertionError
        If it does not; the message names the worst zone, section, size and place, and the report.
    DataError, ToleranceError
        If nothing could be measured.
    """
    from bladecad.pipeline.check import CheckSettings, check

    found = check(nominal, scan, tolerance, settings or CheckSettings(fit=fit), name=name)
    if artefact is not None or not found.within:
        folder = Path(artefact) if artefact is not None else _somewhere()
        page = _kept(found, folder)
    if not found.within:
        raise AssertionError("\n".join(_message(found, page)))
    return found


def _kept(found: Check, folder: Path) -> Path:
    from bladecad.export.check.files import export_check

    return export_check(found, folder, force=True)["page"]


def _somewhere() -> Path:
    return Path(tempfile.mkdtemp(prefix="bladecad-check-"))


def _message(found: Check, page: Path) -> Iterator[str]:
    from bladecad.export.check.worst_place import worst_place

    reasons, worst = found.reasons, found.inspection.worst
    yield f'blade "{found.name}" is out of tolerance'
    if worst:
        yield f"worst: {worst_place(worst[0])}"
    yield from reasons[:SAID]
    if len(reasons) > SAID:
        yield f"and {len(reasons) - SAID} more"
    yield f"report: {page}"
