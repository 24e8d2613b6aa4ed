from __future__ import annotations

import json
import re
from pathlib import Path
from typing import get_args

import numpy as np
import pytest
from typer.testing import CliRunner

from bladecad.cli import app, options
from bladecad.cli.check import parse_axis
from bladecad.deviation.registering.registration import Kind
from bladecad.export.model.model_file import save
from tests.export.products import small
from tests.test_check import scanned


def run(*arguments: object) -> tuple[int, str, str]:
    """Exit code, stdout and stderr of a command."""
    result = CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)
    return result.exit_code, result.stdout, result.stderr


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """A model, a good scan, one with a bump, and a tolerance file."""
    folder, surface = tmp_path_factory.mktemp("check"), small().surface
    names = ("model.json", "good.xyz", "bump.xyz", "tolerance.toml", "negative.toml")
    paths = {name.partition(".")[0]: folder / name for name in names}
    save(surface, paths["model"])
    for name, bump in (("good", 0.0), ("bump", 0.2)):
        np.savetxt(paths[name], scanned(surface, bump=bump, noise=0.002), fmt="%.6f")
    paths["tolerance"].write_text("[zones]\ndefault = 0.05\n")
    paths["negative"].write_text("[zones]\ndefault = 0.05\nleading_edge = -0.1\n")
    return paths


def test_a_good_blade_has_code_0_and_a_report(files, tmp_path):
    code, out, err = run(
        "check", files["model"], files["good"], "--tolerance", files["tolerance"], "--stations",
        "0.3,0.7", "-o", tmp_path / "out", "--name", "fan 7",
    )  # fmt: skip
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert lines[-1] == "within tolerance"
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"report.json", "report.html"}
    report = json.loads((tmp_path / "out" / "report.json").read_text())
    assert report["verdict"]["within"]
    assert report["name"] == "fan 7"
    assert [section["u"] for section in report["sections"]] == [0.3, 0.7]
    for note in report["notes"]:
        assert f"note: {note}" in lines
    for zone in report["zones"]:
        assert any(re.match(rf"{zone['zone']} .* {zone['points']} ", line) for line in lines)
    assert "\x1b" not in out


def test_a_bump_has_code_1_and_is_named_with_size_and_place(files, tmp_path):
    code, out, err = run(
        "check", files["model"], files["bump"], "--tolerance", "0.05", "--fit", "none",
        "--stations", "0.6", "-o", tmp_path / "out", "--csv", "--png",
    )  # fmt: skip
    assert (code, err) == (1, "")
    assert out.splitlines()[-1].startswith("out of tolerance: ")
    (worst,) = (line for line in out.splitlines() if line.startswith("worst"))
    found = re.search(r"\+(\d+) um \((\d+) um out\) on the suction side, .* u = (\S+), t", worst)
    assert found
    assert int(found[1]) == pytest.approx(200, abs=15)
    assert int(found[2]) == pytest.approx(150, abs=15)
    assert float(found[3]) == pytest.approx(0.6, abs=0.03)
    assert "fit         none, as it stands" in out
    assert {"report.json", "report.html", "deviations.csv", "overview.png"} <= {
        path.name for path in (tmp_path / "out").iterdir()
    }


def test_the_quiet_hear_the_verdict_alone(files, tmp_path):
    done = run("check", files["model"], files["good"], "--tolerance", "0.05", "--fit", "none",
               "--stations", "0.6", "-o", tmp_path, "--quiet")  # fmt: skip
    assert done == (0, "within tolerance\n", "")


USAGE = {
    "no tolerance": ([], "Missing option"),
    "number out of sense": (["--tolerance", "-0.1"], "a tolerance of -0.1 mm is no tolerance"),
    "no such file": (["--tolerance", "gone.toml"], "gone.toml.*cannot be read"),
    "negative band": (["--tolerance", "{negative}"], "negative.toml.*leading_edge"),
    "unknown coordinate": (["--tolerance", "1", "--lock", "q"], '"q" cannot be locked'),
    "locked as it stands": (["--tolerance", "1", "--fit", "none", "--lock", "x"], "nothing is fi"),
    "fit": (["--tolerance", "1", "--fit", "worst"], "best"),
    "stations": (["--tolerance", "1", "--stations", "low"], "should be numbers"),
    "station beyond": (["--tolerance", "1", "--stations", "1.5", "--fit", "none"], "0 .. 1"),
    "axis": (["--tolerance", "1", "--span-axis", "1,2"], "should be x, y, z or a direction"),
    "units": (["--tolerance", "1", "--units", "in"], "give --units mm|25.4"),
}


@pytest.mark.parametrize("name", USAGE)
def test_what_is_refused_has_code_2_one_reason_and_leaves_nothing(name, files, tmp_path):
    options, message = USAGE[name]
    told = [option.format(**files) for option in options]
    code, out, err = run("check", files["model"], files["good"], *told, "-o", tmp_path / "out")
    assert (code, out) == (2, "")
    assert re.search(message, " ".join(err.replace("│", " ").split()))
    assert not list(tmp_path.iterdir())


def test_a_folder_in_use_is_kept_and_told_before_anything_is_read(tmp_path):
    (tmp_path / "mine").write_text("mine")
    code, _, err = run("check", "gone", "gone", "--tolerance", "1", "-o", tmp_path)
    assert code == 2
    assert "is not empty and is kept as it is" in err
    assert [path.name for path in tmp_path.iterdir()] == ["mine"]


def test_axes_are_read_as_letters_or_directions():
    assert parse_axis("y") == (0.0, 1.0, 0.0)
    assert parse_axis("1,0,0.5") == (1.0, 0.0, 0.5)


def test_the_fits_offered_are_those_of_the_library():
    assert set(get_args(options.FitChoice)) == set(get_args(Kind))
