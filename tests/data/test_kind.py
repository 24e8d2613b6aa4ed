from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from bladecad.data.kind import kind_of
from bladecad.data.read import read_sections
from bladecad.data.write import WRITERS, write_sections
from bladecad.errors import DataError

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"
GOOD = FIXTURES / "broken" / "good_sides.csv"
STREWN = np.random.default_rng(3).normal(size=(60, 3)) * 20
LOOP = np.column_stack([np.cos(np.arange(60) / 9), np.sin(np.arange(60) / 9), np.zeros(60)]) * 30
ABOVE = LOOP + np.array([0.0, 0.0, 9.0])


def text(points) -> str:
    return "".join(f"{x:.4f} {y:.4f} {z:.4f}\n" for x, y, z in points)


@pytest.mark.parametrize("suffix", WRITERS)
def test_sections_in_any_format_are_sections(suffix: str, tmp_path: Path):
    path = tmp_path / f"blade{suffix}"
    write_sections(read_sections(GOOD), path)
    assert kind_of(path) == "sections"


@pytest.mark.parametrize("form", ["stl", "ply", "obj", "off"])
def test_meshes_are_scans_whatever_their_suffix(form: str, tmp_path: Path):
    path = tmp_path / "scan.dat"
    trimesh.creation.icosphere(subdivisions=1).export(path, file_type=form)
    assert kind_of(path) == "scan"


@pytest.mark.parametrize(
    ("name", "content", "kind"),
    [
        ("a.xyz", text(STREWN), "scan"),
        ("a.csv", "x,y,z\n" + text(STREWN).replace(" ", ","), "scan"),
        ("a.asc", "# scanner\n" + text(STREWN).replace(".", ","), "scan"),
        ("a.pts", "60\n" + text(np.hstack([STREWN])), "scan"),
        ("a.xyz", "Scan 1\n" + text(STREWN) + "Scan 2\n" + text(STREWN), "scan"),
        ("a.txt", text(LOOP) + "\n" + text(ABOVE), "sections"),
        ("a.xyz", "# hub\n" + text(LOOP) + "# tip\n" + text(ABOVE), "sections"),
        ("a.csv", "x,y\n1,2\n", "sections"),
        ("a.csv", "", "sections"),
    ],
)
def test_rows_of_numbers_are_told_by_how_they_follow_each_other(
    name: str, content: str, kind: str, tmp_path: Path
):
    (tmp_path / name).write_text(content)
    assert kind_of(tmp_path / name) == kind


def test_a_large_cloud_is_told_by_its_beginning(tmp_path: Path):
    (tmp_path / "a.xyz").write_text(text(np.tile(STREWN, (200, 1))))
    assert kind_of(tmp_path / "a.xyz") == "scan"


def test_one_loop_a_file_is_sections_where_there_are_more(tmp_path: Path):
    (tmp_path / "s_1.txt").write_text(text(LOOP))
    assert kind_of(tmp_path / "s_1.txt") == "scan"
    (tmp_path / "s_2.txt").write_text(text(ABOVE))
    assert kind_of(tmp_path / "s_1.txt") == "sections"


def test_numbered_clouds_are_scans(tmp_path: Path):
    for k in (1, 2):
        (tmp_path / f"s_{k}.txt").write_text(text(STREWN))
    assert kind_of(tmp_path / "s_1.txt") == "scan"


def test_broken_sections_are_left_to_the_reader_of_sections():
    scans = {path.name for path in (FIXTURES / "broken").iterdir() if kind_of(path) == "scan"}
    assert scans == {"blade.foo"}  # the beginning of an STL
    assert kind_of(FIXTURES / "broken") == "sections"
    assert kind_of(FIXTURES / "none") == "sections"


def test_a_suffix_that_promises_a_mesh_is_held_to_it(tmp_path: Path):
    (tmp_path / "a.ply").write_text("nothing")
    with pytest.raises(DataError, match="is no PLY"):
        kind_of(tmp_path / "a.ply")


def test_a_solid_is_refused(tmp_path: Path):
    (tmp_path / "a.stp").write_text("ISO-10303-21;\nHEADER;\n")
    with pytest.raises(DataError, match=r"a solid already; .* bladecad check"):
        kind_of(tmp_path / "a.stp")
