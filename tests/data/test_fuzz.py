"""Whatever a file holds, the answer is a blade or a DataError that names the file."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bladecad.data.read import read_sections
from bladecad.data.sections import Sections
from bladecad.data.synthetic import synthetic_blade
from bladecad.data.write import WRITERS, write_sections
from bladecad.errors import DataError

SURFACES = """ Z and R are in centimeters
 SURFACE NUMBER     1 FROM THE HUB
    J      Z           R         THETA 1     THETA 2
{rows}
 SURFACE NUMBER     2 FROM THE HUB
{rows}
"""
JUNK = [
    "", "nan", "inf", "-", "1", "a b c", "1 2", "1 2 3 4 5 6", "NI_END", "ni_begin x", "#", ",,,",
    "XYZ", "suction", "99999999", "1e400 0 0", "0 0 0", "begin section", "begin curve", "x,y", "\t",
    "section,x_mm,y_mm,z_m", "-1", "units 0", "profile data file: ..", "0 0", "1.5 3", "é",
]  # fmt: skip


@cache
def good_files() -> dict[str, tuple[str, ...]]:
    """A small good file of every format, as lines."""
    blade = synthetic_blade(2, 12, tagged=True)
    with TemporaryDirectory() as folder:
        for suffix in WRITERS:
            write_sections(blade, Path(folder) / f"blade{suffix}")
        files = {p.name: tuple(p.read_text().splitlines()) for p in Path(folder).iterdir()}
    rows = "\n".join(f"{k} {0.4 * k} 18 {-0.1 + 0.02 * k} {-0.1 + 0.03 * k}" for k in range(9))
    files["surfaces.dat"] = tuple(SURFACES.format(rows=rows).splitlines())
    arc = [f"{k} {k * (8 - k) / 9} 10" for k in range(9)]
    files["arc_1.txt"] = files["arc_2.txt"] = ("X R*THETA R", *arc)
    return files


def answer(folder: Path, name: str) -> Sections | None:
    try:
        return read_sections(folder / name)
    except DataError as error:
        said = str(error)
    assert "blade" in said or name in said or 'section "' in said
    return None


@pytest.mark.parametrize("name", sorted(good_files()))
@settings(max_examples=40)
@given(st.data())
def test_a_file_with_lines_lost_doubled_or_spoilt_is_read_or_refused(
    name: str, data: st.DataObject
):
    lines = list(good_files()[name])
    for _ in range(data.draw(st.integers(0, 3))):
        if lines:
            k = data.draw(st.integers(0, len(lines) - 1))
            new = data.draw(st.sampled_from([[], [lines[k]] * 2, *([junk] for junk in JUNK)]))
            lines[k : k + 1] = new
    lines = lines[: data.draw(st.integers(0, len(lines)))] if data.draw(st.booleans()) else lines
    with TemporaryDirectory() as folder:
        for other, text in good_files().items():
            (Path(folder) / other).write_text("\n".join(text) + "\n")
        (Path(folder) / name).write_text("\n".join(lines), encoding="utf-8")
        answer(Path(folder), name)


@pytest.mark.parametrize("name", sorted(good_files()))
def test_every_good_file_is_read(name: str, tmp_path: Path):
    for other, text in good_files().items():
        (tmp_path / other).write_text("\n".join(text) + "\n")
    reads = {name for name in good_files() if "hub" not in name and "shroud" not in name}
    assert name not in reads or answer(tmp_path, name) is not None


@given(st.binary(max_size=200))
def test_bytes_are_read_or_refused(content: bytes):
    with TemporaryDirectory() as folder:
        file = Path(folder) / "blade.csv"
        file.write_bytes(content)
        answer(Path(folder), file.name)
