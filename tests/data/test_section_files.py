"""SolidWorks curves and PC-DMIS nominals."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bladecad.data.kind import kind_of
from bladecad.data.nominal_points import normals_of, write_nominal
from bladecad.data.read import read_sections
from bladecad.data.sections import Sections
from bladecad.data.synthetic import synthetic_blade
from bladecad.data.text import read_text
from bladecad.data.write import write_sections
from bladecad.errors import DataError, ExportError


def some_normals(blade: Sections) -> list[np.ndarray]:
    rng = np.random.default_rng(5)
    found = [rng.normal(size=section.points.shape) for section in blade.sections]
    return [n / np.linalg.norm(n, axis=1, keepdims=True) for n in found]


def nominal(file: Path, edge: str = "round") -> tuple[Sections, list[np.ndarray]]:
    blade = synthetic_blade(3, 40 + (edge == "blunt"), trailing_edge=edge, tagged=True)
    normals = some_normals(blade)
    write_nominal(blade, file, normals, [180.0, 215.0, 250.0])
    return blade, normals


@pytest.mark.parametrize("edge", ["round", "blunt"])
def test_a_nominal_comes_back_with_its_edges_and_normals(edge: str, tmp_path: Path):
    file = tmp_path / "a.nom"
    blade, normals = nominal(file, edge)
    read = read_sections(file)
    assert (read.source.format, read.source.unit_from) == ("PC-DMIS nominal", "file")
    for a, b in zip(blade.sections, read.sections, strict=True):
        np.testing.assert_allclose(b.points, a.points, rtol=0, atol=1e-7)
        assert (b.name, b.le, b.te, b.closed) == (a.name, a.le, a.te, edge == "round")
    for mine, theirs in zip(normals, normals_of(read_text(file)), strict=True):
        np.testing.assert_allclose(theirs, mine, rtol=0, atol=1e-9)


def test_a_nominal_is_written_as_its_manual_says(tmp_path: Path):
    file = tmp_path / "a.nom"
    nominal(file, "blunt")
    lines = file.read_text().splitlines()
    assert lines[:5] == [
        "UNITS MM", "NUM_SECT 3", "SECTION 1 41 180", "NOSE 21", "TAIL 1 41 SQUARE",
    ]  # fmt: skip
    assert all(len(line.split()) == 6 for line in lines[5:46])
    assert lines[46] == "SECTION 2 41 215"


@pytest.mark.parametrize(
    ("names", "written"),
    [
        (["root A", "r187.5", "tip_2"], ["rootA", "r187p5", "tip2"]),
        (["a_1", "a 1", "b"], ["S1", "S2", "S3"]),
    ],
)
def test_names_have_neither_blank_nor_underscore(names, written, tmp_path: Path):
    blade = synthetic_blade(3, 20, tagged=True)
    pairs = zip(blade.sections, names, strict=True)
    blade = replace(blade, sections=tuple(replace(s, name=name) for s, name in pairs))
    write_nominal(blade, tmp_path / "a.nom", some_normals(blade), [1.0, 2.0, 3.0])
    assert [s.name for s in read_sections(tmp_path / "a.nom").sections] == written


def test_inches_are_read(tmp_path: Path):
    file = tmp_path / "a.nom"
    blade, _ = nominal(file)
    file.write_text(file.read_text().replace("UNITS MM", "units inch"))
    read = read_sections(file)
    assert read.source.unit == "in"
    np.testing.assert_allclose(read.sections[0].points, 25.4 * blade.sections[0].points, rtol=1e-8)


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("NUM_SECT 3", "NUM_SECT 4", "announces 4 sections, 3 follow"),
        ("SECTION 2 40", "SECTION 2 41", r"line 46: 41 points announced, 40 follow"),
        ("TAIL 21", "TAIL 99", r"line 5: point 99 of 40; correct the number"),
        ("SECTION 2 40 215", "SECTION 2", r"line 46: \"\" is no number"),
    ],
)
def test_a_nominal_that_contradicts_itself_is_refused(old, new, said, tmp_path: Path):
    file = tmp_path / "a.nom"
    nominal(file)
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new, 1))
    with pytest.raises(DataError, match=said):
        read_sections(file)


def test_a_normal_that_is_none_is_refused_at_its_line(tmp_path: Path):
    file = tmp_path / "a.nom"
    nominal(file)
    lines = file.read_text().splitlines()
    lines[9] = " ".join([*lines[9].split()[:3], "0.9 0.9 0.9"])
    file.write_text("\n".join(lines))
    with pytest.raises(DataError, match=r"line 10: the normal is 1\.559 long, it must be 1"):
        read_sections(file)


def test_normals_must_be_as_many_as_points(tmp_path: Path):
    blade = synthetic_blade(2, 20, tagged=True)
    few = [normals[1:] for normals in some_normals(blade)]
    with pytest.raises(ExportError, match='section "1": 19 normals for 20 points'):
        write_nominal(blade, tmp_path / "a.nom", few, [1.0, 2.0])


@settings(max_examples=60)
@given(data=st.data())
def test_a_spoilt_nominal_is_read_or_refused(data, tmp_path_factory):
    file = tmp_path_factory.getbasetemp() / "spoilt.nom"
    nominal(file)
    lines = file.read_text().splitlines()
    junk = ["", "SECTION", "NOSE", "TAIL x", "NOSE -1", "NUM_SECT", "UNITS", "1 2", "nan", "²"]
    for _ in range(data.draw(st.integers(1, 3))):
        k = data.draw(st.integers(0, len(lines) - 1))
        lines[k : k + 1] = data.draw(st.sampled_from([[], [lines[k]] * 2, *([j] for j in junk)]))
    file.write_text("\n".join(lines))
    with suppress(DataError):
        assert len(read_sections(file).sections) >= 2


def test_solidworks_has_a_file_for_each_section(tmp_path: Path):
    blade = synthetic_blade(3, 20)
    files = write_sections(blade, tmp_path / "r37.sldcrv")
    assert [file.name for file in files] == ["r37_01.sldcrv", "r37_02.sldcrv", "r37_03.sldcrv"]
    for file, section in zip(files, blade.sections, strict=True):
        rows = np.loadtxt(file)  # bare numbers: anything reads them
        np.testing.assert_allclose(rows[:-1], section.points, rtol=1e-9, atol=1e-9)
        np.testing.assert_array_equal(rows[0], rows[-1])
    for name in (files[1], tmp_path / "r37.sldcrv"):  # any of them, or the name they were given
        read = read_sections(name)
        assert len(read.sections) == 3
        assert read.source.format == "SolidWorks curve"
    with pytest.raises(DataError, match=r"r3\.sldcrv cannot be read: No such file"):
        read_sections(tmp_path / "r3.sldcrv")


def test_an_open_curve_stays_open(tmp_path: Path):
    blade = synthetic_blade(2, 21, trailing_edge="blunt")
    first, _ = write_sections(blade, tmp_path / "a.sldcrv")
    assert [section.closed for section in read_sections(first).sections] == [False, False]


def test_curves_of_an_earlier_blade_are_not_mixed_in(tmp_path: Path):
    write_sections(synthetic_blade(3, 20), tmp_path / "a.sldcrv")
    with pytest.raises(ExportError, match=r"a_03\.sldcrv would be read with the 2 sections"):
        write_sections(synthetic_blade(2, 20), tmp_path / "a.sldcrv")
    assert len(list(tmp_path.iterdir())) == 3


def test_two_curves_in_one_file_are_refused(tmp_path: Path):
    files = write_sections(synthetic_blade(2, 20), tmp_path / "a.sldcrv")
    files[0].write_text(files[0].read_text() + "\n" + files[0].read_text())
    with pytest.raises(DataError, match=r"a_01\.sldcrv, line 23: a second curve begins"):
        read_sections(files[0])


@pytest.mark.parametrize("suffix", [".nom", ".sldcrv"])
def test_both_are_told_from_scans(suffix: str, tmp_path: Path):
    nominal(tmp_path / "a.nom")
    files = write_sections(synthetic_blade(3, 20), tmp_path / "a.sldcrv")
    assert kind_of(files[0] if suffix == ".sldcrv" else tmp_path / "a.nom") == "sections"
