from pathlib import Path

import numpy as np
import pytest

from bladecad.data.read import read_sections
from bladecad.errors import DataError

REFUSED = {
    "empty.csv": "empty.csv is empty; export",
    "rubbish.csv": "rubbish.csv: the content is none of .* known suffixes are .*header section",
    "rubbish.bin": "rubbish.bin is not text .* offset .* export them as CSV",
    "blade.foo": "blade.foo: the content is none of .*TurboGrid.* known suffixes are .*.csv",
    "missing_column.csv": 'missing_column.csv, line 2: no column "z", there are section, x, y; add',
    "missing_cell.csv": 'missing_cell.csv, line 40: column "z" is empty; complete the row',
    "text_in_number.csv": 'text_in_number.csv, line 40: "12.3.4O5" is no number; correct',
    "nan.csv": 'nan.csv, line 90: "nan" is not finite; measure this point again or remove it',
    "one_section.csv": r'one_section.csv: 1 section \("1"\), a surface needs at least 2; give all',
    "three_points.csv": 'three_points.csv: section "2" has 3 points, 8 are needed; measure it',
    "wrong_units.csv": "wrong_units.csv: the blade is 95.25 m large, .* 5 m; .* try --units mm",
}
FOR_THE_CURVES = {  # readable; what is wrong with them only the geometry tells
    "flipped_section.csv",
    "gap.csv",
    "out_of_order.csv",
    "self_crossing.csv",
    "spike.csv",
    "swapped_sides.csv",
}
REPAIRED = {
    "duplicated_points.csv": ('section "2": 2 points repeated, dropped',),
    "readable.foo": ("readable.foo: read as table of points, from its content",),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_broken_file_is_refused_with_the_place_and_what_to_do(fixtures: Path, name: str):
    with pytest.raises(DataError, match=REFUSED[name]):
        read_sections(fixtures / "broken" / name)


@pytest.mark.parametrize("name", REPAIRED)
def test_a_repair_is_told_and_gives_the_whole_blade(fixtures: Path, name: str):
    repaired, good = (read_sections(fixtures / "broken" / n) for n in (name, "good.csv"))
    assert repaired.source.notes == REPAIRED[name]
    for a, b in zip(repaired.sections, good.sections, strict=True):
        np.testing.assert_array_equal(a.points, b.points)


@pytest.mark.parametrize("name", sorted(FOR_THE_CURVES))
def test_what_only_geometry_tells_is_read_without_a_word(fixtures: Path, name: str):
    blade = read_sections(fixtures / "broken" / name)
    assert len(blade.sections) == 4
    assert blade.source.notes == ()


def test_every_broken_file_is_spoken_for(fixtures: Path):
    files = {p.name for p in (fixtures / "broken").iterdir()} - {"good.csv", "good_sides.csv"}
    assert files == REFUSED.keys() | REPAIRED.keys() | FOR_THE_CURVES


def test_the_right_unit_makes_the_wrong_file_good(fixtures: Path):
    blade = read_sections(fixtures / "broken" / "wrong_units.csv", unit="mm")
    good = read_sections(fixtures / "broken" / "good.csv")
    np.testing.assert_array_equal(blade.sections[0].points, good.sections[0].points)
    assert blade.source.notes == ("the file says unit m, but --units mm is taken",)


def test_a_missing_file_is_named(tmp_path: Path):
    with pytest.raises(
        DataError, match=r"none.csv cannot be read: No such file .*; check the path"
    ):
        read_sections(tmp_path / "none.csv")
