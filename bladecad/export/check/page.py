"""report.html of a check: one file that needs nothing else, neither network nor server."""

from __future__ import annotations

import base64
import gzip
from collections.abc import Sequence
from functools import cache
from importlib.resources import files
from typing import Any, Final
from urllib.parse import quote

import numpy as np
from jinja2 import Environment, StrictUndefined
from markupsafe import Markup
from matplotlib import rc_context

from bladecad.deviation.inspecting.inspection import Inspection
from bladecad.export.check.colours import STOPS, limit_of
from bladecad.export.check.data import page_data, script_json
from bladecad.export.check.histogram import Histogram, histogram
from bladecad.export.check.mesh import Painted, painted
from bladecad.export.check.pictures import as_png, as_svg, blade_figure
from bladecad.export.check.plots import STYLE, histogram_figure, section_figure
from bladecad.export.check.report import Report
from bladecad.export.check.whiskers import Whiskers, thinned, whiskers
from bladecad.export.check.words import FILTERS, headline, rows_of

DRAWN: Final = 60  # sections that are drawn for paper, the worst ones
PLACES: Final = 14_000  # of all sections together that are drawn
FEWEST, MOST = 150, 600  # places of one
ON_PAPER: Final = 240  # places of a section, for the eye without a loupe
DPI: Final = 110


def check_page(inspection: Inspection, report: Report) -> str:
    """Return the page of a check.

    Parameters
    ----------
    inspection : Inspection
    report : dict
        What `check_report` tells of it: the tables show the same numbers.
    """
    limit, blade = limit_of(inspection), painted(inspection)
    counted = histogram(inspection, limit)
    sections = section_whiskers(inspection)
    with rc_context(STYLE):
        pictures = _pictures(inspection, blade, sections, counted, limit)
    data = page_data(inspection, blade, sections, counted, limit)
    page: str = _template("page.html.jinja").render(
        report=report,
        headline=headline(report),
        limit=limit,
        stops=STOPS,
        bands=sorted({bound for band in counted.bands for bound in band}),
        beyond=counted.beyond,
        first=first_section(sections),
        rows_of=rows_of,
        data=Markup(script_json(data)),
        css=Markup(_text("page.css")),
        js=Markup(_text("page.js")),
        plotly=Markup(plotly_js()),
        **pictures,
    )
    return page


def section_whiskers(inspection: Inspection) -> list[Whiskers]:
    """Return all sections laid flat, with no more places than a page can hold."""
    most = int(np.clip(PLACES // max(len(inspection.sections), 1), FEWEST, MOST))
    return [thinned(whiskers(inspection, section), most) for section in inspection.sections]


def first_section(sections: Sequence[Whiskers]) -> int:
    """Return the number of the section that is shown first: the worst."""
    ranks = [w.rank[w.worst] if w.worst is not None else -np.inf for w in sections]
    return int(np.argmax(ranks)) if ranks else 0


def _pictures(
    inspection: Inspection,
    blade: Painted,
    sections: Sequence[Whiskers],
    counted: Histogram,
    limit: float,
) -> dict[str, Any]:
    """What is seen on paper and without scripts."""
    ranks = [-w.rank[w.worst] if w.worst is not None else np.inf for w in sections]
    chosen = set(np.argsort(ranks, kind="stable")[:DRAWN].tolist())
    return {
        "blade_picture": _png(as_png(blade_figure(inspection, blade, limit), DPI)),
        "histogram_picture": _svg(as_svg(histogram_figure(counted, limit))),
        "section_pictures": [
            _svg(as_svg(section_figure(thinned(w, ON_PAPER), limit))) if k in chosen else None
            for k, w in enumerate(sections)
        ],
    }


def _png(content: bytes) -> str:
    return f"data:image/png;base64,{base64.b64encode(content).decode()}"


def _svg(text: str) -> str:
    text = text.replace('"', "'") if "'" not in text else text
    return "data:image/svg+xml," + quote(text, safe=" ='/:;,.()-+!*@?&$|{}[]")


@cache
def plotly_js() -> str:
    """Return plotly.js as the plotly package brings it along, gzip in base64: a third of its size.

    The page unpacks it; a browser that cannot (before 2023) shows the pictures for paper.
    """
    content = files("plotly").joinpath("package_data", "plotly.min.js").read_bytes()
    return base64.b64encode(gzip.compress(content, mtime=0)).decode()


def _template(name: str) -> Any:
    environment = Environment(
        autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True
    )
    environment.filters |= FILTERS
    return environment.from_string(_text(name))


def _text(name: str) -> str:
    return files("bladecad.export.check").joinpath("html", name).read_text(encoding="utf-8")
