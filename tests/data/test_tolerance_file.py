"""Tolerance files say what they are read as, and every mistake in one is named."""

import re
from pathlib import Path

import pytest

from bladecad.data.tolerance_file import read_tolerances
from bladecad.errors import ToleranceError
from bladecad.tolerance import PARAMETERS, Band, uniform

PAGE = Path(__file__).resolve().parents[2] / "docs" / "tolerances.md"


def read(tmp_path, text):
    path = tmp_path / "blade.toml"
    path.write_text(text, encoding="utf-8")
    return read_tolerances(path)


def test_the_file_of_the_page_is_read_as_the_page_says(tmp_path):
    page = PAGE.read_text(encoding="utf-8")
    found = read(tmp_path, re.findall(r"```toml\n(.*?)```", page, re.DOTALL)[0])
    assert found.zones["suction side"] == Band(-0.05, 0.05)
    assert found.zones["pressure side"] == Band(-0.04, 0.06)
    assert found.zones["leading edge"] == Band(-0.02, 0.03)
    assert found.zones["trailing edge"] == Band(-0.03, 0.03)
    assert found.zones["hub margin"] == found.zones["tip margin"] == Band(-0.1, 0.1)
    assert found.coverage == {"leading edge": 0.9}
    assert found.parameters["twist"] == Band(-0.1, 0.1)
    assert (found.hub_margin, found.tip_margin, found.allowed_out) == (0.05, 0.03, 0.001)
    assert found.le_offsets == (0.5, 1.0)


def test_the_page_tells_every_number_that_may_be_toleranced():
    page = PAGE.read_text(encoding="utf-8")
    for name in PARAMETERS:
        short = re.sub(
            r"^(trailing_edge|concave|convex)_contour.*", r"\1_...", name.replace(" ", "_")
        )
        short = {"concave_...": "concave_contour_min", "convex_...": "convex_..."}.get(short, short)
        short = short.replace("leading_edge_contour_max", "..._max")
        assert f"`{short}`" in page, name


def test_the_smallest_file_is_the_same_as_one_number(tmp_path):
    found = read(tmp_path, "[zones]\ndefault = 0.05\n")
    assert found == uniform(0.05)


@pytest.mark.parametrize(
    ("unit", "value", "mm"),
    [("um", "50", 0.05), ("in", "0.002", 0.0508), ("mil", "2", 0.0508), ("mm", '"50 um"', 0.05),
     ("in", '"0.05mm"', 0.05), ("um", '"+5e-2 mm"', 0.05)],
)  # fmt: skip
def test_lengths_are_in_the_unit_that_is_nearest_to_them(tmp_path, unit, value, mm):
    found = read(tmp_path, f'unit = "{unit}"\n[zones]\ndefault = {value}\n')
    assert found.zones["suction side"].upper == pytest.approx(mm, rel=1e-12)


ZONES = "[zones]\ndefault = 0.1\n"
WRONG = {
    "zones = 3\n": r"blade.toml, \[zones\]: 3 is no table",
    "[zones]\nfillet = 0.1\n": r"\[zones\] fillet: unknown key; known are default, suction_side",
    "[zones]\nsuction_side = 0.1\n": r"\[zones\] pressure_side: is missing",
    "[zones]\ndefault = -0.1\n": r"\[zones\] default: a band of \+/- -0.1 mm is negative",
    "[zones]\ndefault = [0.2, 0.1]\n": r"upper = 0.1 mm is below lower = 0.2 mm",
    "[zones]\ndefault = [0.1, 0.2]\n": r"0.1 .. 0.2 mm does not hold 0",
    "[zones]\ndefault = [0.1]\n": r"1 numbers, a band is \[lower, upper\]",
    "[zones]\ndefault = true\n": r"\[zones\] default: True is no number",
    "[zones]\ndefault = 50\n": r"50 mm is outside \+/- 10 mm; check its unit",
    "[zones]\ndefault = nan\n": r"nan mm is outside",
    '[zones]\ndefault = "0.1 deg"\n': r'"0.1 deg" is no length; write a number and one of mm, um',
    '[zones]\ndefault = "0.1"\n': r'"0.1" is no length',
    "[zones]\ndefault = {lower = -0.1}\n": "needs both lower and upper",
    "[zones]\ndefault = {lower = -0.1, upper = 0.1, cover = 1}\n": "cover: unknown key|unknown key",
    "[zones]\ndefault = {lower = -0.1, upper = 0.1, coverage = 90}\n": "90 is outside 0 .. 1",
    ZONES + "[extent]\nhub_margin = 0.4\n": r"\[extent\] hub_margin: 0.4 is outside 0 .. 0.25",
    ZONES + "[parameters]\ngirth = 0.1\n": r"\[parameters\] girth: unknown key",
    ZONES + '[parameters]\nchord = "0.1 deg"\n': r"\[parameters\] chord: .* no length",
    ZONES + '[parameters]\ntwist = "0.1 mm"\n': r"\[parameters\] twist: .* no angle",
    ZONES + "[parameters]\nchord = {lower = -1, upper = 1, coverage = 1}\n": "asked of zones",
    ZONES + "[offsets]\nleading_edge = 0.5\n": r"\[offsets\] leading_edge: 0.5 is no list",
    ZONES + "[offsets]\nleading_edge = [0]\n": "at least 0.001 mm",
    'unit = "m"\n' + ZONES: "unit: 'm' is not known; known are mm",
    'format = "other"\n' + ZONES: "this version reads",
    "allowed_out = 5\n" + ZONES: "allowed_out: 5 is outside 0 .. 1",
    "tolerance = 5\n" + ZONES: "tolerance: unknown key",
    "[zones\n": "is no TOML: .*line 1",
    "": r"\[zones\] suction_side: is missing",
}  # fmt: skip


@pytest.mark.parametrize("text", WRONG)
def test_every_mistake_is_named_with_its_place(tmp_path, text):
    with pytest.raises(ToleranceError, match=WRONG[text]) as caught:
        read(tmp_path, text)
    assert str(caught.value).startswith("blade.toml")


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(ToleranceError, match=r"none.toml: cannot be read: No such file"):
        read_tolerances(tmp_path / "none.toml")
