"""`bladecad mesh --passage` and `--row`: what is written, what is said, and what is refused."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import trimesh
import typer
from typer.testing import CliRunner

from bladecad.brep.reread import read_step
from bladecad.cli.mesh import mesh
from bladecad.export.model.model_file import save
from tests.passage.made import COUNT, HUB, SHROUD, row

app = typer.Typer()
app.command()(mesh)
SIZES = ("--size", "6", "--chord-error", "0.05", "--inlet", "20", "--outlet", "20")


@pytest.fixture(scope="module")
def model(tmp_path_factory) -> Path:
    blade = row()
    path = tmp_path_factory.mktemp("model") / "prism.json"
    save(blade.surface, path, machine=blade.machine)
    return path


@pytest.fixture(scope="module")
def alone(tmp_path_factory) -> Path:
    """The same blade, of whose row nothing is known."""
    path = tmp_path_factory.mktemp("model") / "alone.json"
    save(row().surface, path)
    return path


def run(*arguments: object) -> tuple[int, str, str]:
    result = CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)
    return result.exit_code, result.stdout, result.stderr


def table(folder: Path, hub: float = HUB, shroud: float = SHROUD) -> Path:
    rows = [
        f"{n},{z},{r}" for n, r in (("hub", hub), ("shroud", shroud)) for z in range(-60, 61, 20)
    ]
    file = folder / "walls.csv"
    file.write_text("\n".join(["curve,z_mm,r_mm", *rows]))
    return file


def test_a_passage_is_written_with_its_step_and_its_numbers(model: Path, tmp_path: Path):
    code, out, err = run(
        model, "--format", "stl", "-o", tmp_path / "out", "--passage", "--tip-gap", "0.5", "--step",
        *SIZES,
    )  # fmt: skip
    assert (code, err) == (0, "")
    assert {p.name for p in (tmp_path / "out").iterdir()} == {
        "prism_passage.stl", "prism_passage.step", "mesh.json",
    }  # fmt: skip
    said = json.loads((tmp_path / "out" / "mesh.json").read_text())
    assert said["reached"]["blades"] == COUNT
    assert said["reached"]["tip_gap_mm"] == 0.5
    assert said["reached"]["periodic_error_mm"] < 1e-9
    assert said["reached"]["volume_error"] < 1e-4
    assert "closed; chord error" in out
    assert "STEP solid" in out
    solid = read_step(tmp_path / "out" / "prism_passage.step")
    assert solid.volume == pytest.approx(said["reached"]["volume_by_quadrature_mm3"], rel=1e-6)
    body = trimesh.load_mesh(tmp_path / "out" / "prism_passage.stl", force="mesh")
    assert body.volume * 1e9 == pytest.approx(said["volume_mm3"], rel=1e-6)


def test_walls_and_blade_count_from_options_do_for_a_blade_alone(alone: Path, tmp_path: Path):
    asked = ("--walls", table(tmp_path), "--blades", COUNT)
    code, _, _ = run(
        alone, "--format", "msh", "-o", tmp_path / "out", "--row", *asked, *SIZES, "-q"
    )
    assert code == 0
    assert (tmp_path / "out" / "alone_row.msh").is_file()
    said = json.loads((tmp_path / "out" / "mesh.json").read_text())
    assert said["open_edges"] == 0
    assert said["volume_mm3"] == pytest.approx(
        COUNT * said["reached"]["volume_by_quadrature_mm3"], rel=1e-4
    )


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (("--passage",), "nothing of hub and shroud; name one that does by --walls"),
        (("--passage", "--walls", "WALLS"), "how many blades the row has; give --blades"),
        (("--passage", "--walls", "MISSING", "--blades", "24"), "cannot be read"),
        (("--passage", "--walls", "SWAPPED", "--blades", "24"), "the hub is above the shroud"),
        (("--passage", "--walls", "HIGH", "--blades", "24"), "does not cross the passage"),
        (("--passage", "--walls", "WALLS", "--blades", "200"), "crosses its periodic face"),
        (("--passage", "--walls", "WALLS", "--blades", "1"), "a row has 2 at least"),
        (("--passage", "--tip-gap", "-0.1"), "a tip gap of -0.1 mm is asked; 0 or more"),
        (("--passage", "--inlet", "0"), "it must be above 0"),
        (("--passage", "--walls", "WALLS", "--blades", "24", "--size", "0"), "must be above 0"),
        (("--passage", "--walls", "WALLS", "--blades", "24", "--size", "0.01"), "would take"),
        (("--passage", "--walls", "WALLS", "--blades", "24", "--inlet", "0.01"), "is too near it"),
        (("--passage", "--walls", "WALLS", "--blades", "24", "--tip-gap", "30"), "mm at most"),
        (("--passage", "--tip-gap", "1", "--hub-gap", "1"), "stands on one wall at least"),
        (("--passage", "--blades", "24", "--walls", "WALLS", "--edge-size", "1e-7"), "for larger"),
        (("--passage", "--walls", "AXIS", "--blades", "24"), "a radius of 0 mm"),
        (("--blades", "24"), "--blades is about the passage; give --passage or --row"),
        (("--step",), "--step is about the passage"),
    ],
)
def test_what_makes_no_passage_is_refused_and_nothing_written(asked, said, alone, tmp_path):
    files = {
        "WALLS": lambda: table(tmp_path),
        "SWAPPED": lambda: table(tmp_path, SHROUD, HUB),
        "AXIS": lambda: table(tmp_path, 0.0, SHROUD),
        "HIGH": lambda: table(tmp_path, 300.0, 400.0),
        "MISSING": lambda: tmp_path / "nowhere.csv",
    }
    words = [files[word]() if word in files else word for word in asked]
    code, _, err = run(alone, "--format", "stl", "-o", tmp_path / "out", *words)
    assert code == 2
    assert said in err
    assert not (tmp_path / "out").exists()
