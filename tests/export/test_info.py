import json
from pathlib import Path

import pytest

from bladecad.curves.outliers import keep_masks, misprints
from bladecad.curves.repair import repaired
from bladecad.curves.sides import split_sides
from bladecad.data.read import read_sections
from bladecad.data.sections import Sections
from bladecad.data.synthetic import synthetic_blade
from bladecad.export.reports.info import as_dict, describe


def told(blade: Sections) -> str:
    blade = repaired(blade)
    found = misprints(blade)
    return describe(blade, split_sides(blade, keep=keep_masks(blade, found)), misprints=found)


def test_info_tells_what_was_read(fixtures: Path):
    text = told(read_sections(fixtures / "rotor37" / "sections.csv"))
    for line in (
        "file      sections.csv",
        "sections  13, 198 points each, on stream surfaces",
        "unit      mm (from the file)",
        "edges     leading round, trailing round",
        "row       blade count not said, hub and shroud given",
    ):
        assert line in text.splitlines()


def test_info_names_misprints_and_odd_sections(fixtures: Path):
    text = told(read_sections(fixtures / "rotor37-cold" / "tp1337_sections.csv"))
    assert 'section "10", point 99: +0.0254 mm off' in text
    assert 'section "12": stagger 65.34 deg, the other sections lead to 62.' in text


@pytest.mark.parametrize("edge", ["round", "blunt"])
def test_the_table_has_a_row_per_section_and_straight_columns(edge: str):
    blade = synthetic_blade(5, 80, trailing_edge=edge)
    lines = told(blade).splitlines()
    head = next(i for i, line in enumerate(lines) if line.startswith("section  "))
    table = lines[head : head + 6]
    assert len({len(line) for line in table}) == 1
    end = table[0].index("TE radius") + len("TE radius")
    assert all(row[end - 1] in ("-" if edge == "blunt" else "0123456789") for row in table[1:])
    assert [row.split()[0] for row in table[1:]] == ["1", "2", "3", "4", "5"]


def test_the_facts_are_plain_json():
    blade = synthetic_blade(3, 80, trailing_edge="blunt")
    facts = as_dict(blade, split_sides(blade))
    assert json.loads(json.dumps(facts, allow_nan=False)) == facts
    assert facts["sections"][0]["te_radius_mm"] is None
    assert facts["trailing_edge"] == "blunt"
