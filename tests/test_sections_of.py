"""Sections of finished blades: where they are cut, and that what is written is what was cut."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from bladecad.data.read import read_sections
from bladecad.data.sections import Machine, Sections
from bladecad.data.synthetic import synthetic_blade
from bladecad.data.write import WRITERS
from bladecad.errors import ExportError, ToleranceError
from bladecad.pipeline.blade_file import BladeFile, load_blade
from bladecad.pipeline.build import Settings
from bladecad.pipeline.sections_of import CutSettings, sections_of, stacking
from bladecad.pipeline.write_cut import confirm, write_cut
from bladecad.scans.moved import moved_surface
from tests.export.products import small
from tests.surface.test_cuts import rotor

TURN = np.eye(4)  # by 35 degrees about z
TURN[:2, :2] = [[np.cos(0.6), -np.sin(0.6)], [np.sin(0.6), np.cos(0.6)]]


@pytest.fixture(scope="module")
def blade() -> BladeFile:
    return BladeFile("good", small().surface, sections=small().sections)


def test_sections_of_the_input_keep_their_names_and_places(blade: BladeFile):
    found = sections_of(blade)
    assert [cut.name for cut in found.cuts] == ["1", "2", "3", "4"]
    assert [cut.place for cut in found.cuts] == blade.surface.span.tolist()
    assert found.error == 0.0
    assert found.sections.source.format == "streams through good"


@pytest.mark.parametrize("on", ["planes", "cylinders"])
def test_there_are_as_many_sections_as_in_the_input_where_no_number_is_said(on, blade: BladeFile):
    assert len(sections_of(blade, CutSettings(on=on)).cuts) == 4


def test_the_stacking_axis_is_a_coordinate_axis_or_the_line_from_hub_to_tip():
    surface = small().surface
    assert stacking(surface).tolist() == [1.0, 0.0, 0.0]
    leaning = stacking(moved_surface(surface, TURN))
    assert np.degrees(np.arccos(leaning @ TURN[:3, 0])) < 5


def test_planes_along_the_axis_of_a_turned_blade_cut_the_same_sections():
    surface = small().surface
    turned = BladeFile("turned", moved_surface(surface, TURN))
    asked = CutSettings(on="planes", stations=(200.0, 230.0))
    plain = sections_of(BladeFile("plain", surface), asked)
    along = sections_of(turned, replace(asked, span_axis=tuple(TURN[:3, 0].tolist())))
    for a, b in zip(plain.cuts, along.cuts, strict=True):
        # the curvature that spreads the points is rounded otherwise
        np.testing.assert_allclose(a.points @ TURN[:3, :3].T, b.points, rtol=0, atol=1e-6)


def test_the_machine_goes_with_the_sections(blade: BladeFile):
    about = replace(blade, machine=Machine("x"))
    assert sections_of(about).sections.source.axis == "x"


def test_what_cannot_be_asked_for_is_refused(blade: BladeFile):
    with pytest.raises(ToleranceError, match="a span axis is for planes"):
        CutSettings(span_axis="x")
    with pytest.raises(ToleranceError, match="1 station; a file of sections needs 2"):
        sections_of(blade, CutSettings(stations=(0.5,)))


@pytest.mark.parametrize("suffix", [*WRITERS, ".nom"])
def test_a_cut_off_edge_is_read_back_from_every_format(suffix: str, tmp_path: Path):
    found = sections_of(BladeFile("cut off", rotor("blunt")), CutSettings(points=101))
    first, *_ = write_cut(found, tmp_path / f"blade{suffix}")
    for ours, theirs in zip(found.cuts, read_sections(first).sections, strict=True):
        assert len(theirs.points) == 101
        if theirs.te:  # where the format has a word for it
            assert len(theirs.te) == len(ours.te) == 2


def altered(sections: Sections, away: float) -> Sections:
    first, *others = sections.sections
    points = first.points.copy()
    points[3] += away
    return replace(sections, sections=(replace(first, points=points), *others))


def test_what_is_read_back_must_be_what_was_written():
    blade = synthetic_blade(3, 40, tagged=True)
    confirm(blade, blade)
    with pytest.raises(ExportError, match=r'section "1" is read back 0\.001 mm off'):
        confirm(blade, altered(blade, 1e-3))
    with pytest.raises(ExportError, match="2 sections are read back of 3"):
        confirm(blade, replace(blade, sections=blade.sections[:2]))
    swapped = [replace(section, suction="second") for section in blade.sections]
    with pytest.raises(ExportError, match=r'section "1" is read back .* mm off'):
        confirm(blade, replace(blade, sections=tuple(swapped)))


@pytest.mark.parametrize(
    ("file", "count"),
    [("hannover-4ac-front/1_Rotor1_Blade.crv", 23), ("stac-turbine/R1_TS-3_profile.crv", 39)],
)
def test_published_blades_are_cut_anywhere(file, count, shared_data: Path, tmp_path: Path):
    published = load_blade(shared_data / file, Settings(tolerance=0.02))
    for on in ("planes", "cylinders"):
        found = sections_of(published, CutSettings(on=on, stations=7))
        assert found.error < 1e-9
        assert found.between < 2e-3
        first, *_ = write_cut(found, tmp_path / f"{on}.geomTurbo")
        again = read_sections(first)
        assert len(again.sections) == 7
        assert again.row.blade_count == count
