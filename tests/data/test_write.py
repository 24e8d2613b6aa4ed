from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bladecad.arrays import Points
from bladecad.data.loops import arcs, size
from bladecad.data.read import read_sections
from bladecad.data.sections import Arc, Row, Section, Sections
from bladecad.data.synthetic import synthetic_blade
from bladecad.data.write import WRITERS, write_sections, write_with
from bladecad.errors import ExportError
from tests.strategies import blades

PRINTED = 1e-9  # of the size: ten digits


def there_and_back(blade: Sections, suffix: str) -> Sections:
    with TemporaryDirectory() as folder:
        first, *_ = write_sections(blade, Path(folder) / f"blade{suffix}")
        return read_sections(first)


def same_points(a: Points, b: Points) -> None:
    np.testing.assert_allclose(a, b, rtol=0, atol=PRINTED * (size(a) + float(np.abs(a).max())))


def same_sides(a: Section, b: Section) -> None:
    for section in (a, b):
        assert arcs(section) is not None
    ours, theirs = arcs(a), arcs(b)
    if a.suction and b.suction and a.suction != b.suction:
        theirs = theirs[::-1]
    for mine, other in zip(ours, theirs, strict=True):
        same_points(mine, other)


@given(blades(tagged=False), st.sampled_from(sorted(WRITERS.keys() - {".geomturbo"})))
def test_loops_come_back_as_they_were(blade: Sections, suffix: str):
    back = there_and_back(blade, suffix)
    for a, b in zip(blade.sections, back.sections, strict=True):
        same_points(a.points, b.points)
        assert (a.closed, a.le, a.te) == (b.closed, b.le, b.te)


@given(blades(tagged=True), st.sampled_from([".csv", ".curve", ".geomturbo"]))
def test_edges_and_sides_come_back_as_they_were(blade: Sections, suffix: str):
    back = there_and_back(blade, suffix)
    for a, b in zip(blade.sections, back.sections, strict=True):
        assert len(a.le) == len(b.le)
        assert len(a.te) == len(b.te)
        same_sides(a, b)
    assert back.source.axis == "z"
    assert back.row.blade_count == blade.row.blade_count


@given(blades(tagged=True))
def test_creo_keeps_edges_and_sides_beside_one_curve(blade: Sections):
    for a, b in zip(blade.sections, there_and_back(blade, ".ibl").sections, strict=True):
        same_points(a.points, b.points)
        assert (a.closed, a.le, a.te, a.suction) == (b.closed, b.le, b.te, b.suction)


@given(blades(tagged=True), st.sampled_from(["first", "second", None]))
def test_turbogrid_says_which_side_is_suction(blade: Sections, suction: Arc | None):
    named = [replace(section, suction=suction) for section in blade.sections]
    back = there_and_back(replace(blade, sections=tuple(named)), ".curve")
    assert {section.suction for section in back.sections} == {suction}


def test_turbogrid_says_nothing_where_loops_run_either_way(tmp_path: Path):
    blade = synthetic_blade(2, 20, tagged=True)
    other = replace(blade.sections[1], suction="second")
    blade = replace(blade, sections=(blade.sections[0], other))
    assert {s.suction for s in there_and_back(blade, ".curve").sections} == {None}


@settings(max_examples=10)
@given(blades(tagged=True), st.sampled_from([".csv", ".curve", ".geomturbo"]))
def test_hub_and_shroud_come_back(blade: Sections, suffix: str):
    row = Row(
        23, np.array([[-10.0, 50.0], [40, 55.5]]), np.array([[-10.0, 80.0], [0, 79], [40, 78]])
    )
    back = there_and_back(Sections(blade.sections, blade.source, row), suffix).row
    assert back.blade_count == 23
    np.testing.assert_allclose(back.hub, row.hub, rtol=1e-9)
    np.testing.assert_allclose(back.shroud, row.shroud, rtol=1e-9)


def test_autogrid_needs_named_sides(tmp_path: Path):
    with pytest.raises(ExportError, match='section "1": AutoGrid needs suction and pressure side'):
        write_sections(synthetic_blade(2, 20), tmp_path / "blade.geomTurbo")
    assert not list(tmp_path.iterdir())


def test_files_appear_together_or_not_at_all(tmp_path: Path):
    blade, file = synthetic_blade(2, 20), tmp_path / "blade.curve"
    assert [path.name for path in write_sections(blade, file)] == ["blade.curve", "blade.inf"]
    before = {path.name: path.read_text() for path in tmp_path.iterdir()}
    file.unlink()
    with pytest.raises(ExportError, match=r"blade\.inf exists and is kept as it is; .* --force"):
        write_sections(blade, file, force=False)
    assert [path.name for path in tmp_path.iterdir()] == ["blade.inf"]
    write_sections(blade, file)
    assert {path.name: path.read_text() for path in tmp_path.iterdir()} == before


def test_what_is_not_confirmed_is_not_seen(tmp_path: Path):
    def refuse(file: Path) -> None:
        assert file.name == "blade.curve"
        assert len(read_sections(file).sections) == 2
        raise ExportError("not what it should be")

    with pytest.raises(ExportError, match="not what it should be"):
        write_with(
            WRITERS[".curve"], synthetic_blade(2, 20), tmp_path / "blade.curve", confirm=refuse
        )
    assert not list(tmp_path.iterdir())


def test_a_missing_folder_and_a_folder_in_the_way_are_named(tmp_path: Path):
    with pytest.raises(ExportError, match=r"none/blade\.csv cannot be written: No such file"):
        write_sections(synthetic_blade(2, 20), tmp_path / "none" / "blade.csv")
    (tmp_path / "blade.inf").mkdir()
    with pytest.raises(ExportError, match=r"blade\.inf is a folder; name a file in it"):
        write_sections(synthetic_blade(2, 20), tmp_path / "blade.curve")
    assert [path.name for path in tmp_path.iterdir()] == ["blade.inf"]


def test_a_nominal_needs_normals(tmp_path: Path):
    with pytest.raises(ExportError, match=r"a nominal holds normals, .* bladecad convert"):
        write_sections(synthetic_blade(2, 20), tmp_path / "blade.nom")


def test_an_unknown_suffix_is_refused_with_the_known_ones(tmp_path: Path):
    with pytest.raises(ExportError, match=r'not written as "\.foo"; choose one of \.csv, .*\.nom$'):
        write_sections(synthetic_blade(2, 20), tmp_path / "blade.foo")


def test_walls_of_an_earlier_blade_are_not_taken_for_those_of_a_new_one(tmp_path: Path):
    walls = (np.array([[0.0, r], [50.0, r]]) for r in (100.0, 150.0))
    blade = synthetic_blade()
    write_sections(replace(blade, row=Row(None, *walls)), tmp_path / "b.csv")
    with pytest.raises(ExportError, match=r"b_hub_shroud\.csv would be read with b\.csv"):
        write_sections(replace(blade, row=Row()), tmp_path / "b.csv", force=True)
    assert len(read_sections(tmp_path / "b.csv").row.hub) == 2
