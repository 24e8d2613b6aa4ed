from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from bladecad.cli.mesh import FormatChoice, mesh
from bladecad.export.model.model_file import save
from bladecad.pipeline.mesh import MeshFormat
from tests.meshes.blades import blade

WRITTEN = {
    "openfoam": {"Allrun", "constant", "system", "mesh.json"},
    "stl": {"fan.stl", "mesh.json"},
    "msh": {"fan.msh", "mesh.json"},
    "plot3d": {"fan.xyz", "mesh.json"},
    "vtk": {"mesh.json", "fan.vtp", "fan_suction.vts", "fan_pressure.vts", "fan_hub.vts",
            "fan_tip.vts"},
}  # fmt: skip
app = typer.Typer()
app.command()(mesh)


@pytest.fixture(scope="module")
def model(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("model") / "fan.json"
    save(blade(), path, provenance={})
    return path


def run(*arguments: object) -> tuple[int, str, str]:
    result = CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)
    return result.exit_code, result.stdout, result.stderr


def test_formats_are_those_of_the_library():
    assert FormatChoice.__args__ == MeshFormat.__args__


@pytest.mark.parametrize("form", WRITTEN)
def test_every_format_is_written_with_its_report(form: str, model: Path, tmp_path: Path):
    output = tmp_path / "out"
    asked = ("--size", "4", "--chord-error", "0.05", "--edge-size", "0.3", "--growth", "1.3")
    code, out, err = run(model, "--format", form, "-o", output, *asked)
    assert (code, err) == (0, "")
    assert {p.name for p in output.iterdir()} == WRITTEN[form]
    said = json.loads((output / "mesh.json").read_text())
    assert said["asked"] == {"size_mm": 4, "chord_error_mm": 0.05, "growth": 1.3, "edge_mm": 0.3}
    assert said["open_edges"] == 0
    assert said["reached"]["chord_error_mm"] <= 0.05
    assert said["reached"]["growth"] <= 1.3 * 1.001
    assert said["triangles"] == sum(found["triangles"] for found in said["patches"].values())
    for name, found in said["patches"].items():
        assert name in out
        assert found["smallest_angle"] > 0.1
        assert 0 < found["skewness"] < 1
    listed = {entry["file"]: entry["bytes"] for entry in said["files"]}
    files = {f.relative_to(output).as_posix(): f.stat().st_size for f in output.rglob("*")
             if f.is_file() and f.name != "mesh.json"}  # fmt: skip
    assert listed == files


def test_a_folder_in_use_is_kept_and_force_replaces_the_mesh_in_it(model: Path, tmp_path: Path):
    case = (model, "-o", tmp_path, "--size", "6", "--chord-error", "0.1", "-q")
    (tmp_path / "mine.txt").write_text("mine")
    code, _, err = run(*case, "--format", "stl")
    assert (code, [p.name for p in tmp_path.iterdir()]) == (2, ["mine.txt"])
    assert "--force" in err
    assert run(*case, "--format", "openfoam", "--force")[0] == 0
    assert (tmp_path / "system" / "blockMeshDict").is_file()
    assert run(*case, "--format", "openfoam", "--force", "--name", "fan7")[0] == 0
    surfaces = {p.name for p in (tmp_path / "constant" / "triSurface").iterdir()}
    assert surfaces == {"fan7.stl", "fan7.eMesh", "fan7_blade.eMesh"}
    assert (tmp_path / "mine.txt").read_text() == "mine"


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (["--format", "fluent"], "fluent"),
        (["--format", "stl", "--size", "0"], "size of 0 mm is asked; it must be above 0"),
        (["--format", "stl", "--size", "-2"], "size of -2 mm"),
        (["--format", "stl", "--chord-error", "0"], "chord error of 0 mm"),
        (["--format", "stl", "--edge-size", "-0.1"], "edge size of -0.1 mm"),
        (["--format", "stl", "--growth", "1"], "growth of 1 is asked; it must be above 1"),
        (["--format", "stl", "--size", "0.005"], "ask for a larger one"),
        (["--format", "openfoam", "--edge-size", "5e-4", "--size", "9"], "refinements, 9 at most"),
        (["--name", "../x", "--format", "stl"], "is no name for a file"),
        ([], "--format"),
    ],
)
def test_what_makes_no_sense_has_code_2_and_writes_nothing(
    wrong: list[str], words: str, model: Path, tmp_path: Path
):
    code, out, err = run(model, "-o", tmp_path / "out", *wrong)
    assert (code, out) == (2, "")
    assert words in " ".join(err.replace("│", " ").split())
    assert not list(tmp_path.iterdir())


def test_a_model_that_is_missing_is_told(tmp_path: Path):
    code, _, err = run(tmp_path / "none.json", "--format", "stl", "-o", tmp_path / "out")
    assert code == 2
    assert "cannot be read" in err
    assert not list(tmp_path.iterdir())


def test_without_a_size_it_is_a_fortieth_of_the_longest_chord(model: Path, tmp_path: Path):
    assert run(model, "--format", "plot3d", "-o", tmp_path, "-q")[0] == 0
    u = np.linspace(0.0, 1.0, 9)
    ends = blade()("suction", u, np.array([0.0, 1.0]))
    chord = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).max()
    said = json.loads((tmp_path / "mesh.json").read_text())
    assert said["asked"]["size_mm"] == pytest.approx(chord / 40, rel=1e-6)
