"""All files of a check: the report to read, the report to look at, tables and pictures."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Final

from bladecad.export.check.checked import Checked
from bladecad.export.check.colours import limit_of
from bladecad.export.check.csv import write_csv
from bladecad.export.check.histogram import histogram
from bladecad.export.check.mesh import painted
from bladecad.export.check.page import check_page, section_whiskers
from bladecad.export.check.pictures import figures, write_pngs
from bladecad.export.check.report import check_report
from bladecad.export.stage import REPORT, staged
from bladecad.export.text import write_json

DIGITS: Final = 9  # of the numbers in the report
PAGE: Final = "report.html"
TABLE: Final = "deviations.csv"


def export_check(
    check: Checked,
    folder: str | os.PathLike[str],
    *,
    csv: bool = False,
    png: bool = False,
    force: bool = False,
) -> dict[str, Path]:
    """Write the report of a check, as JSON and as a page to open in a browser.

    Parameters
    ----------
    check : Checked
        A finished check, within tolerance or not.
    folder : path
        New or empty; made where it is missing.
    csv : bool
        Also write `deviations.csv`, a row for every point.
    png : bool
        Also write the pictures of the page: overview, histogram, every section.
    force : bool
        Replace the files of an earlier check in the folder.

    Returns
    -------
    dict
        "report" and "page", and where asked for "table" and every picture by name, to their paths.

    Raises
    ------
    ExportError
        If the folder is in use or cannot be written; it is then as it was.
    """
    with staged(folder, force=force) as stage:
        files = _write(check, stage, csv=csv, png=png)
        content = check_report(check, files=files)
        write_json(content, stage / REPORT, digits=DIGITS)
    found = {"report": stage / REPORT, **files}
    return {kind: Path(folder) / path.name for kind, path in found.items()}


def _write(check: Checked, stage: Path, *, csv: bool, png: bool) -> dict[str, Path]:
    found = check.inspection
    files = {"page": stage / PAGE}
    files["page"].write_text(check_page(found, check_report(check)), encoding="utf-8")
    if csv:
        files["table"] = stage / TABLE
        write_csv(found, files["table"])
    if png:
        limit = limit_of(found)
        drawn = figures(found, painted(found), section_whiskers(found),
                        histogram(found, limit), limit)  # fmt: skip
        files |= {path.stem: path for path in write_pngs(drawn, stage)}
    return files
