"""`bladecad convert` where sections are cut from the blade itself."""

from __future__ import annotations

from pathlib import Path
from typing import get_args

import numpy as np
import pytest
import shapely

from bladecad.cli import convert as command
from bladecad.data.nominal_points import normals_of
from bladecad.data.read import read_sections
from bladecad.data.sections import Machine, Row
from bladecad.data.text import read_text
from bladecad.export.model.model_file import load, save
from bladecad.pipeline.blade_file import load_blade
from bladecad.pipeline.build import Settings, split
from bladecad.pipeline.build import load as read
from bladecad.surface.blade import normals
from bladecad.surface.cuts import On
from bladecad.surface.loft import SIDES, graded
from tests.cli.test_commands import run
from tests.export.products import FIXTURES, GOOD, small

CUT = (".csv", ".curve", ".geomTurbo", ".ibl", ".sldcrv", ".nom", ".txt")
PRINTED = 1e-6  # mm, of ten digits


@pytest.fixture(scope="module")
def model(tmp_path_factory) -> Path:
    """A blade of four sections, with the machine round it."""
    file = tmp_path_factory.mktemp("model") / "blade.json"
    hub, shroud = [[-10.0, 170.0], [60.0, 175.0]], [[-10.0, 260.0], [60.0, 265.0]]
    row = Row(36, np.array(hub), np.array(shroud))
    save(small().surface, file, machine=Machine("z", row))
    return file


def first_of(file: Path) -> Path:
    return file if file.exists() else file.with_name(f"{file.stem}_01{file.suffix}")


def test_choices_are_those_of_the_library():
    assert set(get_args(command.OnChoice)) == set(get_args(On))


@pytest.mark.parametrize("suffix", CUT)
def test_a_model_is_cut_into_any_format_and_reads_back_on_the_surface(
    suffix: str, model: Path, tmp_path: Path
):
    file = tmp_path / f"blade{suffix}"
    code, out, err = run("convert", model, file, "--stations", "3", "--points", "60", "--on",
                         "cylinders")  # fmt: skip
    assert (code, err) == (0, "")
    assert "3 sections of 60 points on cylinders, read back" in out
    found = read_sections(first_of(file))
    assert [len(section.points) for section in found.sections] == [60] * 3
    for section in found.sections:
        r = np.hypot(*section.points[:, :2].T)
        assert np.ptp(r) < PRINTED
    if suffix in (".csv", ".curve", ".geomTurbo"):
        assert found.row.blade_count == 36
        np.testing.assert_allclose(found.row.hub, [[-10.0, 170.0], [60.0, 175.0]])


@pytest.mark.parametrize("suffix", CUT)
def test_sides_are_read_back_as_they_were_written(suffix: str, model: Path, tmp_path: Path):
    surface, file = load(model), tmp_path / f"blade{suffix}"
    run("convert", model, file, "--points", "160")
    settings = Settings()
    sections, _, keep = read(first_of(file), settings)
    lines = split(sections, settings, keep)
    middle = surface("suction", surface.span, np.array([0.5]))[:, 0]
    for track, point in zip(lines.suction, middle, strict=True):
        fine = track(np.linspace(0.3, 0.7, 4001))
        assert np.linalg.norm(fine - point, axis=1).min() < 0.02  # half a step, and the fit
    if suffix not in (".sldcrv", ".txt"):
        for section, lead in zip(
            sections.sections, surface("suction", surface.span, np.zeros(1))[:, 0], strict=True
        ):
            np.testing.assert_allclose(section.points[section.le[0]], lead, atol=PRINTED)


def test_a_blade_cut_and_fitted_again_is_the_same_blade(model: Path, tmp_path: Path):
    first, file = load(model), tmp_path / "blade.curve"
    run("convert", model, file)
    again = load_blade(file, Settings(tolerance=0.005))
    u, t = np.linspace(0, 1, 9), graded(201)
    for side in SIDES:
        away = again.surface(side, u, t) - first(side, u, t)
        assert np.linalg.norm(away, axis=2).max() < 0.1  # along the skin: t is not quite the same
        across = np.einsum("utx,utx->ut", away, normals(first, side, u, t))
        assert np.abs(across).max() < 0.007


def test_a_nominal_holds_the_normals_of_the_surface(model: Path, tmp_path: Path):
    file = tmp_path / "blade.nom"
    assert (
        run("convert", model, file, "--on", "planes", "--points", "80", "--stations", "2")[0] == 0
    )
    sections, found = read_sections(file).sections, normals_of(read_text(file))
    for section, n in zip(sections, found, strict=True):
        assert np.linalg.norm(n, axis=1) == pytest.approx(1.0, abs=1e-9)
        metal = shapely.Polygon(section.points[:, 1:])
        outside, inside = (section.points + h * n for h in (0.05, -0.05))
        assert not shapely.contains_xy(metal, *outside[:, 1:].T).any()
        assert shapely.contains_xy(metal, *inside[:, 1:].T).all()


@pytest.mark.parametrize(
    ("asked", "names"),
    [
        (["--stations", "0.25,0.75"], ["u0.25", "u0.75"]),
        (["--stations", "3"], ["u0", "u0.5", "u1"]),
        (["--on", "planes", "--stations", "200,240"], ["x200", "x240"]),
        (["--on", "cylinders", "--stations", "240,200.5"], ["r200.5", "r240"]),
        (["--on", "planes", "--span-axis", "1,0,0.1", "--stations", "205,235"], ["h205", "h235"]),
    ],
)
def test_stations_are_a_number_or_places(asked, names, model: Path, tmp_path: Path):
    code, _, err = run("convert", model, tmp_path / "a.csv", "--points", "40", *asked)
    assert (code, err) == (0, "")
    assert [s.name for s in read_sections(tmp_path / "a.csv").sections] == names


def test_sections_are_fitted_before_they_are_cut(tmp_path: Path):
    code, out, _ = run("convert", GOOD, tmp_path / "a.csv", "--points", "50")
    assert code == 0
    assert "um from the sections that were read" in out
    back = read_sections(tmp_path / "a.csv").sections
    assert [section.name for section in back] == ["1", "2", "3", "4"]
    assert {len(section.points) for section in back} == {50}


def test_planes_tell_what_they_are_square_to(model: Path, tmp_path: Path):
    _, out, _ = run("convert", model, tmp_path / "a.csv", "--on", "planes")
    assert "note: planes are square to x, the stacking axis; --span-axis to choose" in out


def test_sections_beyond_the_blade_are_told(model: Path, tmp_path: Path):
    _, out, _ = run("convert", model, tmp_path / "a.csv", "--stations=-0.02,0.5,1.03")
    assert "2 sections reach up to 3 % of the span beyond hub or tip" in out


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (["--stations", "0"], "0 stations; a file of sections needs 2"),
        (["--stations", "-4"], "-4 stations"),
        (["--stations", "0.5,0.5"], "each place once"),
        (["--stations", "0.5,"], "should be numbers"),
        (["--stations", "many"], "should be numbers"),
        (["--stations", "nan,0.5"], "each place once, and finite"),
        (["--points", "0"], "0 points round a section"),
        (["--points", "-60"], "-60 points round a section"),
        (["--on", "planes", "--stations", "200,400"], "plane x = 400 mm misses the blade"),
        (["--on", "planes", "--span-axis", "z"], "plane z = const cuts the blade"),
        (["--on", "cylinders", "--stations", "20,200"], "r = 20 mm misses the blade"),
        (["--on", "cones"], "cones"),
        (["--span-axis", "x"], "a span axis is for planes"),
        (["--stations", "0.2,1.2"], "u = 1.2 misses the blade"),
    ],
)
def test_what_cannot_be_cut_is_refused_and_nothing_is_written(
    asked, said: str, model: Path, tmp_path: Path
):
    code, out, err = run("convert", model, tmp_path / "a.curve", *asked)
    assert (code, out) == (2, "")
    assert said in " ".join(err.split())
    assert not list(tmp_path.iterdir())


def test_files_beside_are_kept_too(model: Path, tmp_path: Path):
    (tmp_path / "a.inf").write_text("mine")
    code, _, err = run("convert", model, tmp_path / "a.curve")
    assert code == 2
    assert "a.inf exists and is kept as it is" in err
    assert [path.name for path in tmp_path.iterdir()] == ["a.inf"]
    code, out, _ = run("convert", model, tmp_path / "a.curve", "--force")
    assert code == 0
    assert "a.curve, with a.inf, a_hub.curve, a_shroud.curve" in out


def test_units_of_a_model_and_broken_input_are_refused(model: Path, tmp_path: Path):
    assert run("convert", model, tmp_path / "a.csv", "--units", "in")[0] == 2
    assert run("convert", tmp_path / "none.json", tmp_path / "a.csv")[0] == 2
    broken = FIXTURES / "broken" / "nan.csv"
    assert run("convert", broken, tmp_path / "a.csv", "--stations", "5")[0] == 2
    assert run("convert", model, tmp_path / "a.dwg")[0] == 2
    code, _, err = run("convert", GOOD, tmp_path / "a.csv", "--le", "low")
    assert (code, "--le low is for sections that are cut" in err) == (2, True)
    assert not list(tmp_path.iterdir())
