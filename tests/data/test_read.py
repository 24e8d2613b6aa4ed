"""Each published file says what SOURCE.md says it does."""

from pathlib import Path

import numpy as np
import pytest

from bladecad.data.read import read_sections
from bladecad.data.synthetic import synthetic_blade
from bladecad.data.write import write_sections
from bladecad.errors import DataError

#   file, format, sections, points in the first and last, closed, unit, axis, blades, hub, shroud
PUBLISHED = """
nasa-rotor37/ar355_sections.csv | table of points | 13 | 198 198 | yes | mm z | None | 0 0
nasa-rotor37/rotor37geometry.dat | NASA surface table | 13 | 198 198 | yes | cm z | None | 31 32
nasa-rotor37/turbogrid/profile.curve | TurboGrid | 6 | 300 300 | yes | cm z | 36 | 211 209
nasa-rotor37/turbogrid/BladeGen.inf | TurboGrid | 6 | 300 300 | yes | cm z | 36 | 211 209
nasa-rotor37/turbogrid | TurboGrid | 6 | 300 300 | yes | cm z | 36 | 211 209
nasa-rotor37/csv/R37_profile04.csv | table of points | 6 | 300 300 | yes | cm x | 36 | 30 30
nasa-rotor37/csv | table of points | 6 | 300 300 | yes | cm x | 36 | 30 30
nasa-rotor37/Rotor37_Autoblade.geomTurbo | AutoGrid geomTurbo | 12 | 236 236|yes|m z|36|100 100
nasa-rotor37/tp1337_points.csv | NASA manufacturing table | 12 | 121 134 | yes | in z | None | 0 0
nasa-rotor37/tp1337_sections.csv | NASA manufacturing table | 12 | 121 134 | yes | in z | None | 0 0
geomturbo-samples/cc_autoblade.geomTurbo | AutoGrid geomTurbo | 2 | 219 219 |yes|m z|12|100 100
geomturbo-samples/rotor_db.geomTurbo | AutoGrid geomTurbo | 9 | 222 222 | yes | m z | 36 | 57 57
hannover-4ac-front/0_IGV_Vane.crv | TurboGrid | 5 | 120 120 | yes | mm z | 26 | 13 13
hannover-4ac-front/1_Rotor1_Blade.inf | TurboGrid | 7 | 120 120 | yes | mm z | 23 | 13 13
hannover-4ac-front/2_Stator1_Vane.crv | TurboGrid | 7 | 120 120 | yes | mm z | 30 | 13 13
hannover-4ac-front/3_Rotor2_Blade.crv | TurboGrid | 7 | 120 120 | yes | mm z | 27 | 13 13
hannover-4ac-front/4_Stator2_Vane.crv | TurboGrid | 7 | 120 120 | yes | mm z | 32 | 13 13
stac-turbine/R1.inf | TurboGrid | 21 | 83 66 | no | m z | 39 | 582 371
stac-turbine/S1_TS-1_profile.crv | TurboGrid | 21 | 66 107 | no | m z | 39 | 593 777
"""


@pytest.mark.parametrize("line", PUBLISHED.strip().splitlines(), ids=lambda line: line.split()[0])
def test_a_published_blade_is_read_as_described(shared_data: Path, line: str):
    file, form, count, points, closed, frame, blades, curves = map(str.strip, line.split("|"))
    blade = read_sections(shared_data / file)
    found = blade.sections
    assert blade.source.format == form
    assert len(found) == int(count)
    assert [len(found[0].points), len(found[-1].points)] == [int(n) for n in points.split()]
    assert {s.closed for s in found} == {closed == "yes"}
    assert f"{blade.source.unit} {blade.source.axis}" == frame
    assert (blade.source.unit_from, blade.source.axis_from) == ("file", "file")
    assert str(blade.row.blade_count) == blades
    assert [len(blade.row.hub), len(blade.row.shroud)] == [int(n) for n in curves.split()]


def test_the_blade_lies_between_hub_and_shroud(shared_data: Path):
    for name in ("nasa-rotor37/turbogrid", "nasa-rotor37/csv", "nasa-rotor37/rotor37geometry.dat"):
        blade = read_sections(shared_data / name)
        for section, curve in (
            (blade.sections[0], blade.row.hub),
            (blade.sections[-1], blade.row.shroud),
        ):
            r = np.linalg.norm(np.delete(section.points, blade.axis, axis=1), axis=1)
            wall = np.interp(section.points[:, blade.axis], *curve.T)
            assert np.abs(r - wall).max() < 0.8  # mm; the tip gap of 0.36 mm and more


def test_a_numbered_family_is_one_blade_whichever_member_is_named(shared_data: Path):
    folder = shared_data / "nasa-hecc-main" / "design"
    stem = "HECCvanedCoordinates_impeller_main_blade_section_"
    by_first, by_seventh = (read_sections(folder / f"{stem}{k}.txt") for k in ("01", "07"))
    by_list = read_sections(sorted(folder.glob(f"{stem}*.txt")))
    for blade in (by_first, by_seventh, by_list):
        assert blade.source.format == "R*THETA table"
        assert [len(s.points) for s in blade.sections] == [len(s.points) for s in by_first.sections]
        assert len(blade.sections) == 11
        assert not any(s.closed for s in blade.sections)
        assert (blade.source.unit, blade.source.unit_from) == ("in", "default")
        assert any("section_07.txt: read as R*THETA table, like" in n for n in blade.source.notes)
    assert "11 sections, one a file" in by_first.source.notes[-2]
    assert len(by_first.row.hub) == 350


def test_a_folder_of_several_blades_asks_for_one(shared_data: Path):
    with pytest.raises(DataError, match=r"design holds .*EGV_0.*section_0.*; name the one file"):
        read_sections(shared_data / "nasa-hecc-main" / "design")


def test_a_cut_off_edge_is_told_from_a_round_one(shared_data: Path):
    blunt = read_sections(shared_data / "geomturbo-samples/cc_autoblade.geomTurbo")
    for section in blunt.sections:
        assert (section.le, section.te, section.suction) == ((0,), (109, 110), "first")
        gap = np.linalg.norm(section.points[110] - section.points[109])
        assert 1.9 < gap < 3.1
    assert blunt.source.notes == ("the main blade was read; 1 splitter of the row left out",)
    round_edged = read_sections(shared_data / "nasa-rotor37/Rotor37_Autoblade.geomTurbo")
    assert {(s.le, s.te) for s in round_edged.sections} == {((0,), (118,))}


def test_an_option_wins_over_the_file_and_says_so(fixtures: Path):
    good = read_sections(fixtures / "broken" / "good.csv")
    blade = read_sections(fixtures / "broken" / "good.csv", unit="cm", axis="y")
    np.testing.assert_allclose(blade.sections[0].points, 10 * good.sections[0].points)
    assert (blade.source.unit_from, blade.source.axis_from) == ("option", "option")
    assert blade.axis == 1
    assert blade.source.notes == (
        "the file says unit mm, but --units cm is taken",
        "the file says axis z, but --axis y is taken",
    )


def test_a_file_that_says_nothing_is_taken_in_mm_about_z_with_a_line_that_says_so(tmp_path: Path):
    file = tmp_path / "blade.txt"
    write_sections(synthetic_blade(3, 30), file)
    source = read_sections(file).source
    assert (source.unit, source.unit_from, source.axis, source.axis_from) == (
        ("mm", "default", "z", "default")
    )
    assert source.notes == (
        "the file does not say its unit: mm is taken; --units says otherwise",
        "the file does not say its axis: z is taken; --axis says otherwise",
    )


def test_radii_and_angles_stand_about_any_axis(shared_data: Path):
    file = shared_data / "nasa-rotor37" / "rotor37geometry.dat"
    about_z, about_x = read_sections(file), read_sections(file, axis="x")
    assert about_x.source.notes == ()
    for a, b in zip(about_z.sections, about_x.sections, strict=True):
        np.testing.assert_array_equal(np.roll(a.points, 1, axis=1), b.points)
    np.testing.assert_array_equal(about_z.row.hub, about_x.row.hub)


VARIANTS = {
    "byte order mark, carriage returns and blank lines": lambda t: "﻿" + t.replace("\n", "\r\n\r\n"),
    "tabs": lambda t: t.replace(",", "\t"),
    "semicolons and decimal commas": lambda t: t.replace(",", ";").replace(".", ","),
    "blanks": lambda t: t.replace(",", "  "),
    "upper case and a space before the unit": lambda t: t.replace(
        "x_mm,y_mm,z_mm", "X [mm],Y [mm],Z [mm]"
    ),
    "signed numbers": lambda t: t.replace(",1", ",+1"),
}


@pytest.mark.parametrize("variant", VARIANTS)
@pytest.mark.parametrize("name", ["good.csv", "good_sides.csv"])
def test_the_dialect_of_a_table_does_not_matter(
    fixtures: Path, tmp_path: Path, variant: str, name: str
):
    file = tmp_path / name
    file.write_text(VARIANTS[variant]((fixtures / "broken" / name).read_text()), newline="")
    blade, good = read_sections(file), read_sections(fixtures / "broken" / name)
    for a, b in zip(blade.sections, good.sections, strict=True):
        np.testing.assert_array_equal(a.points, b.points)
        assert (a.name, a.le, a.te, a.suction) == (b.name, b.le, b.te, b.suction)


def test_formatted_point_data_says_its_counts(tmp_path: Path):
    blade = synthetic_blade(3, 30)
    rows = "\n".join(f"{x:.10g} {y:.10g} {z:.10g}" for s in blade.sections for x, y, z in s.points)
    file = tmp_path / "blade3d.case.dat"
    file.write_text(f"30 3\n{rows}\n")
    read = read_sections(file)
    assert [len(s.points) for s in read.sections] == [30, 30, 30]
    assert (read.source.axis, read.source.axis_from) == ("x", "file")
    file.write_text(f"30 4\n{rows}\n")
    with pytest.raises(
        DataError, match="line 1: 30 points in 4 sections announced, 90 rows follow"
    ):
        read_sections(file)
