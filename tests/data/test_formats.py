"""What each format can say beyond points."""

from pathlib import Path

import numpy as np
import pytest

from bladecad.data.loops import arcs, two_sides
from bladecad.data.read import read_sections
from bladecad.data.synthetic import synthetic_blade
from bladecad.data.write import write_sections
from bladecad.errors import DataError


def rewritten(file: Path, *changes: tuple[str, str]) -> Path:
    text = file.read_text()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    file.write_text(text)
    return file


@pytest.mark.parametrize(
    ("factor", "unit", "scale"),
    [("0.3048", "ft", 304.8), ("0.0254", "in", 25.4), ("0.5", "mm", 500)],
)
def test_autogrid_units_are_metres_a_number(tmp_path: Path, factor: str, unit: str, scale: float):
    blade, file = synthetic_blade(2, 20, tagged=True), tmp_path / "a.geomTurbo"
    write_sections(blade, file)
    read = read_sections(rewritten(file, ("units 1", f"units {factor}")), unit=None)
    assert read.source.unit == unit
    expected = blade.sections[0].points / 1000 * scale
    np.testing.assert_allclose(read.sections[0].points, expected, rtol=1e-9, atol=1e-9)


def test_autogrid_keywords_are_read_in_either_case_and_in_cylindrical_coordinates(tmp_path: Path):
    blade, file = synthetic_blade(2, 20, tagged=True), tmp_path / "a.geomTurbo"
    write_sections(blade, file)
    lines = file.read_text().upper().splitlines()
    rows = [
        k
        for k, line in enumerate(lines)
        if len(line.split()) == 3 and line.split()[0][-1].isdigit()
    ]
    for k in rows:
        x, y, z = map(float, lines[k].split())
        lines[k] = f"{z} {np.hypot(x, y)} {np.arctan2(y, x)}"
    file.write_text("\n".join("ZRTH" if line.strip() == "XYZ" else line for line in lines))
    for a, b in zip(read_sections(file).sections, blade.sections, strict=True):
        np.testing.assert_allclose(a.points, b.points, atol=1e-9)


def test_a_truncated_autogrid_file_is_refused_at_the_line(tmp_path: Path):
    file = tmp_path / "a.geomTurbo"
    write_sections(synthetic_blade(2, 20, tagged=True), file)
    lines = file.read_text().splitlines()
    file.write_text("\n".join(lines[:-12]))
    with pytest.raises(
        DataError, match=r"line \d+: 11 points announced, \d+ follow; export it again"
    ):
        read_sections(file)


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_autogrid_is_written_about_z_whatever_the_axis(tmp_path: Path, axis: str):
    blade, file = synthetic_blade(2, 20, tagged=True), tmp_path / "a.geomTurbo"
    turned = tmp_path / "turned.txt"
    write_sections(blade, turned)
    write_sections(blade, tmp_path / "a.csv")
    rewritten(tmp_path / "a.csv", ("z axial", f"{axis} axial"))
    about = read_sections(tmp_path / "a.csv")
    write_sections(about, file)
    read = read_sections(file)
    column = "xyz".index(axis)
    for a, b in zip(read.sections, about.sections, strict=True):
        np.testing.assert_allclose(a.points[:, 2], b.points[:, column], atol=1e-9)
        first, second, third = a.points[[0, 5, 9]]
        one, two, three = b.points[[0, 5, 9]]
        hands = np.linalg.det([first, second, third]), np.linalg.det([one, two, three])
        assert hands[0] == pytest.approx(hands[1], rel=1e-6)


def test_turbogrid_tags_mark_round_and_cut_off_edges(tmp_path: Path):
    for edge, le, te in (("round", (0,), (20,)), ("blunt", (20,), (40, 0))):
        blade = synthetic_blade(2, 40 + (edge == "blunt"), trailing_edge=edge, tagged=True)
        write_sections(blade, tmp_path / f"{edge}.curve")
        read = read_sections(tmp_path / f"{edge}.curve")
        assert {(s.le, s.te) for s in read.sections} == {(le, te)}


def test_a_profile_finds_its_own_inf_among_several(tmp_path: Path):
    blade = synthetic_blade(2, 20)
    for name in ("rotor", "stator"):
        write_sections(blade, tmp_path / f"{name}.curve")
    rewritten(
        tmp_path / "stator.inf", ("Units: MM", "Units: CM"), ("stator.curve", "../x/tor.curve")
    )
    (tmp_path / "rotor.curve").rename(tmp_path / "R1_rotor.curve")
    rewritten(tmp_path / "rotor.inf", ("rotor.curve", "..\\far\\away\\rotor.curve"))
    assert read_sections(tmp_path / "rotor.inf").source.unit == "mm"
    assert read_sections(tmp_path / "R1_rotor.curve").source.unit == "mm"


def test_an_inf_without_its_profile_asks_for_it(tmp_path: Path):
    write_sections(synthetic_blade(2, 20), tmp_path / "rotor.curve")
    (tmp_path / "rotor.curve").unlink()
    with pytest.raises(
        DataError, match=r'names the profile "rotor.curve", which is not in .*; put it'
    ):
        read_sections(tmp_path / "rotor.inf")


def test_two_ibl_curves_in_a_section_are_its_sides(tmp_path: Path):
    blade = synthetic_blade(2, 20, tagged=True)
    lines = ["Open Index Arclength"]
    for k, section in enumerate(blade.sections, 1):
        lines.append(f"begin section ! {k}")
        for side in arcs(section) or ():
            lines += [
                "  begin curve ! 1",
                *(f"{i} {x} {y} {z}" for i, (x, y, z) in enumerate(side, 1)),
            ]
    file = tmp_path / "blade.ibl"
    file.write_text("\n".join(lines))
    for a, b in zip(read_sections(file).sections, blade.sections, strict=True):
        np.testing.assert_array_equal(a.points, b.points)
        assert (a.le, a.te) == (b.le, b.te)


def test_sides_in_either_direction_make_the_same_loop():
    first, second = arcs(synthetic_blade(2, 20, tagged=True).sections[0]) or ()
    along, against = two_sides("1", first, second), two_sides("1", first, second[::-1])
    np.testing.assert_array_equal(along.points, against.points)
    assert along.closed


def test_a_narrow_gap_between_points_round_an_edge_is_not_a_cut():
    section = synthetic_blade(2, 60, tagged=True).sections[0]
    first, second = arcs(section) or ()
    round_edged = two_sides("1", first, second[1:])
    assert (round_edged.le, round_edged.closed) == ((0,), True)


def test_hub_and_shroud_come_from_the_table_beside(fixtures: Path):
    row = read_sections(fixtures / "rotor37" / "sections.csv").row
    assert (len(row.hub), len(row.shroud)) == (31, 32)
    np.testing.assert_allclose(row.hub[0], [-228.60001, 175.25999])


def test_sides_must_be_two(tmp_path: Path, fixtures: Path):
    file = tmp_path / "a.csv"
    file.write_text((fixtures / "broken" / "good_sides.csv").read_text())
    with pytest.raises(
        DataError, match=r"section \"1\": sides 'suction', two are needed; name them"
    ):
        read_sections(rewritten(file, (",pressure,", ",suction,")))
