from pathlib import Path

import pytest

from bladecad.data.blocks import blocks
from bladecad.data.text import Text, numbers, read_text, write_text
from bladecad.errors import DataError, ExportError


@pytest.mark.parametrize(
    ("line", "values"),
    [
        ("1 2 3", [1, 2, 3]),
        ("\t1.5,\t-2.5 ; 3 ,", [1.5, -2.5, 3]),
        ("+119", [119]),
        ("0.123-0.456 7.", [0.123, -0.456, 7]),
        ("-1.0D-03+2.5d+01", [-1e-3, 25]),
        (".5e-2-.25E+1", [0.005, -2.5]),
    ],
)
def test_numbers_are_read_as_fortran_and_spreadsheets_write_them(line: str, values: list[float]):
    assert numbers(Text(Path("a.csv"), (line,)), 0) == values


@pytest.mark.parametrize("field", ["1.2.3", "3.4O5", "12-05-2024", "1_000", "0x10", "--1", "1e"])
def test_what_is_no_number_is_named_with_its_place(field: str):
    text = Text(Path("blade.csv"), ("1 2 3", f"1 {field} 3"))
    with pytest.raises(DataError, match=rf'blade\.csv, line 2: "{field}" is no number'):
        numbers(text, 1)


@pytest.mark.parametrize("field", ["nan", "NaN", "-inf", "Infinity", "1.#QNAN", "*****", "1e999"])
def test_what_is_not_finite_is_named_with_its_place(field: str):
    with pytest.raises(DataError, match=r"line 1: .* is not finite; measure this point again"):
        numbers(Text(Path("blade.csv"), (f"1 2 {field}",)), 0)


def test_a_short_row_is_named():
    with pytest.raises(DataError, match="line 1: 2 numbers, 3 are needed"):
        numbers(Text(Path("blade.csv"), ("1 2",)), 0, count=3)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
@pytest.mark.parametrize("newline", ["\n", "\r\n", "\r"])
def test_encodings_and_line_ends_do_not_matter(tmp_path: Path, encoding: str, newline: str):
    file = tmp_path / "a.txt"
    file.write_bytes(newline.join(["# é", "1 2 3"]).encode(encoding))
    assert read_text(file).lines == ("# é", "1 2 3")


def test_decimal_commas_become_points_only_where_all_numbers_have_them(tmp_path: Path):
    file = tmp_path / "a.csv"
    file.write_text("x;y;z\n1,5;2,5;-3,25\n")
    assert read_text(file).lines == ("x;y;z", "1.5;2.5;-3.25")
    file.write_text("x,y,z\n1,5,3\n1.5,2,3\n")
    assert read_text(file).lines[1] == "1,5,3"


def test_blank_lines_split_points_unless_every_group_has_a_heading():
    rows = ("1 2 3", "", "1 2 3")
    assert len(blocks(Text(Path("a"), rows))) == 2
    headed = ("# a", *rows, "## no heading", "# b", *rows)
    assert [len(b.rows) for b in blocks(Text(Path("a"), headed))] == [2, 2]


def test_a_file_that_cannot_be_written_leaves_nothing_behind(tmp_path: Path):
    with pytest.raises(ExportError, match="cannot be written"):
        write_text(tmp_path / "missing" / "a.csv", "x")
    (tmp_path / "taken.csv").mkdir()
    with pytest.raises(ExportError, match="cannot be written"):
        write_text(tmp_path / "taken.csv", "x")
    assert [p.name for p in tmp_path.iterdir()] == ["taken.csv"]
