"""The command `bladecad cam-sheet`, from file to files."""

import json
from pathlib import Path

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from bladecad.cli.cam_sheet import cam_sheet
from bladecad.export.model.model_file import save
from tests.cam.blades import good, tube

FILES = {"cam.json", "cam.csv", "cam.png"}


@pytest.fixture(scope="session")
def model(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("cam") / "blade.json"
    save(good(), path)
    return path


def run(*arguments: object) -> tuple[int, str, str]:
    app = typer.Typer()
    app.command()(cam_sheet)
    result = CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)
    return result.exit_code, result.stdout, result.stderr


@pytest.fixture(scope="session")
def made(model, tmp_path_factory) -> tuple[Path, str]:
    folder = tmp_path_factory.mktemp("cam") / "sheet"
    code, out, _ = run(model, "-o", folder, "--ball", 2, "--scallop", 0.01)
    assert code == 0
    return folder, out


def test_a_sheet_is_numbers_a_table_and_a_picture(made):
    folder, out = made
    assert {file.name for file in folder.iterdir()} == FILES
    facts = json.loads((folder / "cam.json").read_text())
    assert facts["schema"] == "bladecad-cam/1"
    assert facts["cutting"] == {"ball_radius_mm": 2.0, "scallop_mm": 0.01, "tolerance_mm": 0.05}
    for head in ("suction side", "concave", "largest ball", "leading edge", "along chord", "bar"):
        assert f"\n{head}" in f"\n{out}"
    assert out.splitlines()[-1].startswith("point milling: ")


def test_the_table_has_the_rows_of_the_facts(made):
    facts = json.loads((made[0] / "cam.json").read_text())
    table = np.genfromtxt(made[0] / "cam.csv", delimiter=",", names=True)
    assert table.dtype.names == ("u", "leading_edge_mm", "trailing_edge_mm", "thickness_mm")
    for name in table.dtype.names:
        np.testing.assert_allclose(table[name], [row[name] for row in facts["rows"]], rtol=1e-5)
    assert (np.diff(table["u"]) > 0).all()
    assert table["leading_edge_mm"].min() == pytest.approx(
        facts["edges"]["leading"]["least_mm"], rel=1e-5
    )


def test_the_picture_is_one_page_with_something_on_it(made):
    from matplotlib.image import imread

    picture = imread(made[0] / "cam.png")
    assert picture.shape[:2] == (1101, 1800)
    left, right = picture[200:900, :450, :3], picture[200:900, 550:, :3]
    assert np.mean(left.min(axis=2) < 0.9) > 0.2  # the blade
    assert np.mean(right.min(axis=2) < 0.9) > 0.1  # the panels


def test_what_bounds_nothing_is_null(tmp_path):
    save(tube(10.0, 3.0), tmp_path / "tube.json")
    code, out, _ = run(tmp_path / "tube.json", "-o", tmp_path / "sheet")
    facts = json.loads((tmp_path / "sheet" / "cam.json").read_text())
    assert code == 0
    assert facts["largest_ball_radius"]["mm"] is None
    assert "any ball" in out
    assert out.splitlines()[-1].startswith("flank milling: ")


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--ball", 0), "give more than 0"),
        (("--scallop", -1), "give more than 0"),
        (("--tolerance", "nan"), "give more than 0"),
        (("--scallop", 3, "--ball", 2), "below the radius"),
    ],
)
def test_numbers_without_sense_are_refused_and_nothing_is_written(model, tmp_path, options, said):
    code, out, error = run(model, "-o", tmp_path / "sheet", *options)
    assert code == 2
    assert said in error
    assert not out
    assert not [*tmp_path.iterdir()]


def test_a_folder_in_use_is_kept(made, model, tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    code, _, error = run(model, "-o", tmp_path)
    assert code == 2
    assert "--force" in error
    assert [file.name for file in tmp_path.iterdir()] == ["mine.txt"]


def test_a_missing_model_is_said(tmp_path):
    code, _, error = run(tmp_path / "none.json", "-o", tmp_path / "sheet")
    assert code == 2
    assert "none.json" in error
    assert not [*tmp_path.iterdir()]


def test_the_quiet_hear_the_verdict_alone(model, tmp_path, monkeypatch):
    monkeypatch.setattr("bladecad.pipeline.cam.write_cam_sheet", lambda *a, **k: ({}, FACTS))
    code, out, _ = run(model, "-o", tmp_path / "sheet", "-q")
    assert code == 0
    assert (
        out == "flank milling: a cylinder along rulings would be 0.01 mm off, 0.05 mm are allowed\n"
    )


FACTS = {"flank_milling": {"possible": True, "error_mm": 0.01}}
