"""All files of a check appear together, and the page stands for itself."""

import hashlib
import html
import json
import re
from dataclasses import replace
from html.parser import HTMLParser

import matplotlib.image
import numpy as np
import pytest
from matplotlib import rc_context

from bladecad.errors import ExportError
from bladecad.export.check import files as check_files
from bladecad.export.check.colours import limit_of
from bladecad.export.check.files import export_check
from bladecad.export.check.page import plotly_js
from bladecad.export.check.pictures import as_svg, slug
from bladecad.export.check.plots import STYLE, section_figure, signed
from bladecad.export.check.whiskers import whiskers
from bladecad.export.check.words import band, headline, number, percent, rows_of, tidy
from bladecad.tolerance import uniform
from tests.export.inspections import blade, bump, checked, inspection

EVIL = "</script><script>alert('x')</script><img src=x onerror=alert(1)> & \"q\""


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    check = checked(name="fan 7")
    return check, export_check(check, tmp_path_factory.mktemp("c") / "out", csv=True, png=True)


class Elements(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.found = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.found.append((tag, dict(attrs)))


def page(check, folder):
    return export_check(check, folder)["page"].read_text(encoding="utf-8")


def own(text):
    """The page without plotly.js."""
    return text.replace(plotly_js(), "")


def test_all_files_are_there_and_the_report_knows_them(written):
    _, files = written
    content = json.loads(files["report"].read_text(encoding="utf-8"))
    entries = {entry["is"]: entry for entry in content["files"]}
    assert entries.keys() == files.keys() - {"report"}
    assert {"page", "table", "overview", "histogram", "section-01-S1"} <= files.keys()
    for kind, entry in entries.items():
        data = files[kind].read_bytes()
        assert (entry["bytes"], entry["sha256"]) == (len(data), hashlib.sha256(data).hexdigest())
    assert {p.name for p in files["report"].parent.iterdir()} == {p.name for p in files.values()}


def test_the_page_is_small_and_asks_for_nothing(written):
    text = written[1]["page"].read_text(encoding="utf-8")
    assert len(text.encode()) < 8e6
    for tag, attributes in Elements(own(text)).found:
        for key in ("src", "href", "data", "action", "poster"):
            address = attributes.get(key, "data:")
            assert address.startswith(("data:", "#")), (tag, address)
    assert "@import" not in own(text)
    assert not re.search(r"url\((?!data:)", own(text).split("</style>")[0])


def test_the_verdict_stands_first_and_says_by_how_much_and_where(written):
    check, files = written
    text = own(files["page"].read_text(encoding="utf-8"))
    worst = check.inspection.worst[0]
    body = text[text.index("<body>") :]
    told = body[: body.index("</header>")]
    assert "Out of tolerance" in told
    assert f"{worst.excess:.3f} mm" in told
    assert worst.zone in told
    assert worst.section in told
    assert html.escape(check.inspection.reasons[0]) in told


def test_without_scripts_every_table_and_picture_is_there(written):
    check, files = written
    text = own(files["page"].read_text(encoding="utf-8"))
    text = text[: text.index('<script type="application/json"')]
    for section in check.inspection.sections:
        for n in section.numbers:
            assert n.name in text
    assert text.count("data:image/svg+xml,") == len(check.inspection.sections) + 1
    assert text.count("data:image/png;base64,") == 1
    for value in ("ab" * 32, "cd" * 32, "trimesh.proximity", "T_nominal_scan", "no points there"):
        assert value in text
    assert "nan" not in re.sub(r'"data:[^"]*"', "", text).lower()
    assert "None" not in re.sub(r'"data:[^"]*"', "", text)


def test_names_from_outside_are_text_and_never_markup(tmp_path):
    found = inspection(count=300, stations=2, name=EVIL)
    text = own(page(checked(found, name=EVIL, notes=(EVIL,)), tmp_path / "out"))
    assert "<img src=x" not in text
    assert "alert('x')</script>" not in text
    names = [tag for tag, _ in Elements(text).found]
    assert names.count("script") == 3
    data = text[text.index('id="data">') + 10 :]
    sections = json.loads(data[: data.index("</script>")])["sections"]
    assert sections[0]["name"].startswith(EVIL)


@pytest.mark.parametrize(
    "found",
    [
        lambda: inspection(blade("blunt"), count=600),
        lambda: inspection(count=3, stations=1, cells=(2, 3)),
        lambda: inspection(count=200, stations=0),
        lambda: inspection(count=300, stations=9, cells=(4, 6)),
        lambda: inspection(count=400, tolerances=uniform(0.2)),
        lambda: replace(inspection(count=100), referee=None, worst=(), zones=()),
    ],
    ids=["blunt", "three points", "no sections", "many sections", "uniform", "bare"],
)
def test_any_inspection_has_a_page(found, tmp_path):
    text = page(checked(found()), tmp_path / "out")
    assert "<h1>blade</h1>" in text
    assert len(text) < 8e6


def test_pictures_show_the_bump_red_and_the_worn_edge_blue(written):
    image = matplotlib.image.imread(written[1]["overview"])[..., :3]
    assert image.shape == (990, 1500, 3)
    left = image[:800, :740]
    assert bump(0, 0.6, 0.4) > 0.1  # the bump is on the suction side, which is on the left
    assert (left[..., 0] > left[..., 2] + 0.4).mean() > 0.005
    assert (left[..., 2] > left[..., 0] + 0.2).mean() > 0.003
    for name in ("histogram", "section-02-S2"):
        picture = matplotlib.image.imread(written[1][name])[..., :3]
        assert 0.5 < (picture == 1.0).all(axis=2).mean() < 0.995


def test_a_drawn_section_is_small_and_keeps_the_digits_of_its_labels():
    found = inspection()
    w = whiskers(found, found.sections[1])
    with rc_context(STYLE):
        text = as_svg(section_figure(w, limit_of(found)))
    assert f"{signed(w.deviation[w.worst])} mm" in text
    assert len(text) < 90_000


def test_an_earlier_check_is_replaced_only_when_asked(tmp_path):
    check = checked(inspection(count=100, stations=1))
    export_check(check, tmp_path / "out", csv=True)
    with pytest.raises(ExportError, match="not empty"):
        export_check(check, tmp_path / "out")
    export_check(check, tmp_path / "out", force=True)
    assert {p.name for p in (tmp_path / "out").iterdir()} == {"report.json", "report.html"}


def test_where_one_file_fails_none_is_written(tmp_path, monkeypatch):
    def fail(*_):
        raise OverflowError("late")

    monkeypatch.setattr(check_files, "write_csv", fail)
    with pytest.raises(OverflowError):
        export_check(checked(inspection(count=100, stations=1)), tmp_path / "out", csv=True)
    assert not list(tmp_path.iterdir())


def test_words_for_numbers_that_are_there_and_that_are_not():
    assert [number(x) for x in (None, np.nan, -1.5)] == ["–", "–", "−1.5000"]
    assert [tidy(x) for x in (0.0, -0.05, 0.1)] == ["0", "−0.05", "+0.1"]
    assert [band(x) for x in (None, [-0.1, 0.1], [-0.1, 0.2])] == ["–", "±0.1", "−0.1 … +0.2"]
    assert [percent(x) for x in (None, 0.0, 0.123)] == ["–", "0.0 %", "12.3 %"]
    assert rows_of({"a": {"b": 1.5, "c": None}, "d": [1, 2], "e": {}}) == [
        ("a.b", "1.5"), ("a.c", "–"), ("d", "1, 2"), ("e", "–")
    ]  # fmt: skip
    assert headline({"worst": []}) == "No point was inspected."
    assert slug("S 1/α") == "S-1"
    assert slug("///") == "section"
