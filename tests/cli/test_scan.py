"""`bladecad build` and `bladecad sections` on scans."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import bladecad
from bladecad.cli import app
from bladecad.data.write import WRITERS
from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.deviation.nearest.project import project
from bladecad.pipeline import scan as pipeline
from bladecad.pipeline.scan_build import ScanBuild
from bladecad.scans.moved import moved_points
from tests.export.products import GOOD
from tests.scans.truth import scan_of, truth_surface

SIGMA = 0.005


def run(*arguments: object) -> tuple[int, str, str]:
    result = CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)
    return result.exit_code, result.stdout, result.stderr


@pytest.fixture(scope="module")
def scan(tmp_path_factory) -> Path:
    """Triangles of a blade in any pose."""
    made = scan_of(truth_surface("synthetic"), 25_000, sigma=SIGMA, pose="any", mesh=True, seed=5)
    return made.write(tmp_path_factory.mktemp("scan") / "scan.ply")


@pytest.fixture(scope="module")
def aligned(scan) -> tuple[Path, int, str, str, ScanBuild]:
    """The files of `build --align`, what was said, and the blade."""
    folder, build, found = scan.parent / "aligned", pipeline.build_scan, []

    def kept(*arguments, **options):
        found.append(build(*arguments, **options))
        return found[-1]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pipeline, "build_scan", kept)
        said = run("build", scan, "-o", folder, "--align", "--tolerance", "0.02")
    return folder, *said, *found


def test_a_scan_is_built_and_the_numbers_are_printed(aligned):
    folder, code, out, err, _ = aligned
    assert (code, err) == (0, "")
    assert out.splitlines()[-1] == "within 20 um"
    report = json.loads((folder / "report.json").read_text())
    heads = {line.split("  ")[0] for line in out.splitlines()}
    assert {"scan", "airfoil", "order", "noise", "spans", "systematic", "that count", "worst",
            "deviation", "referee", "B-rep to S", "witnesses", "files", "in"} <= heads  # fmt: skip
    for entry in report["files"]:
        assert entry["file"] in out
        assert (folder / entry["file"]).stat().st_size == entry["bytes"]
    assert report["scan"]["triangles"] > 0


def test_the_transform_leads_from_the_scan_to_the_files(aligned, scan):
    folder, *_ = aligned
    report = json.loads((folder / "report.json").read_text())
    move = np.array(report["scan"]["transform"])
    assert np.linalg.det(move[:3, :3]) == pytest.approx(1.0)
    surface = bladecad.load(folder / "scan.json")
    points = moved_points(bladecad.read_scan(scan).points, move)
    feet = project(nominal_of(surface), points[::20])
    inside = ~feet.rim
    assert inside.mean() > 0.8
    assert np.sqrt(np.mean(feet.distance[inside] ** 2)) < 1.5 * SIGMA
    hub, tip = surface("suction", np.array([0.0, 1.0]), np.linspace(0.0, 1.0, 9))
    assert abs(hub[:, 2]).max() < 0.1
    assert tip[:, 2].min() > 50.0
    assert hub[-1, 0] > hub[0, 0]
    assert hub[-1, 1] == pytest.approx(hub[0, 1], abs=1e-6)


def test_out_of_tolerance_the_files_are_written_and_say_so(
    aligned, tmp_path: Path, scan, monkeypatch
):
    found = replace(aligned[-1], settings=pipeline.ScanSettings(tolerance=1e-6))
    monkeypatch.setattr(pipeline, "build_scan", lambda *_, **__: found)
    code, out, err = run("build", scan, "-o", tmp_path / "out")
    assert (code, err) == (1, "")
    assert out.splitlines()[-1].startswith("out of tolerance: ")
    report = json.loads((tmp_path / "out" / "report.json").read_text())
    assert not report["verdict"]["within"]
    assert len(list((tmp_path / "out").iterdir())) == 6


@pytest.mark.parametrize("suffix", [*WRITERS])
def test_sections_are_written_in_any_format_and_read_again(suffix: str, cut, tmp_path: Path):
    output = tmp_path / f"cut{suffix}"
    code, out, err = run("sections", "scan.ply", "-o", output)
    assert (code, err) == (0, "")
    assert f"{output}: 9 sections" in out
    again = bladecad.read_sections(output)
    assert len(again.sections) == 9
    lines = bladecad.split_sides(again)
    for one, other in zip(cut.sections, again.sections, strict=True):
        same = np.linalg.norm(one.points[:, None] - other.points, axis=2).min(axis=1)
        assert same.max() < 1e-5
    assert len(lines.names) == 9


@pytest.fixture(scope="module")
def cut_once(scan):
    return pipeline.sections_of_scan(scan, pipeline.ScanSettings(stations=9))


@pytest.fixture
def cut(cut_once, monkeypatch: pytest.MonkeyPatch):
    """Let `sections` give what was cut before."""
    monkeypatch.setattr(pipeline, "sections_of_scan", lambda *_, **__: cut_once)
    return cut_once


def test_a_file_of_sections_is_kept_unless_forced_and_never_half_written(cut, tmp_path: Path):
    output = tmp_path / "cut.csv"
    output.write_text("mine")
    code, _, err = run("sections", "scan.ply", "-o", output)
    assert code == 2
    assert "--force" in err
    assert output.read_text() == "mine"
    assert run("sections", "scan.ply", "-o", output, "--force", "--quiet") == (0, "", "")
    assert len(bladecad.read_sections(output).sections) == 9
    code, _, err = run("sections", "scan.ply", "-o", tmp_path / "cut.dwg")
    assert code == 2
    assert '".dwg"; choose one of .csv' in err
    assert [path.name for path in tmp_path.iterdir()] == ["cut.csv"]


def text(points: np.ndarray) -> str:
    return "".join(f"{x:.4f} {y:.4f} {z:.4f}\n" for x, y, z in points)


BALL = np.random.default_rng(1).normal(size=(20_000, 3))
BALL *= 30.0 / np.linalg.norm(BALL, axis=1, keepdims=True)
CUBE = np.random.default_rng(2).uniform(-20.0, 20.0, size=(20_000, 3))
CUBE[np.arange(20_000), np.arange(20_000) % 3] = 20.0 * (-1.0) ** (np.arange(20_000) // 3)
PLANE = np.random.default_rng(3).uniform(-20.0, 20.0, size=(20_000, 3)) * [1.0, 1.0, 1e-4]
BAD = {
    "ball.xyz": text(BALL),
    "cube.xyz": text(CUBE),
    "plane.xyz": text(PLANE),
    "few.xyz": text(BALL[:40]),
    "empty.xyz": "",
    "blank.ply": "   \n",
    "wrong.ply": text(BALL[:100]),
    "cut.pts": "20001\n" + text(BALL),
    "cut.stl": "solid blade\n facet normal 0 0 1\n",
    "row.asc": text(BALL[:3000]) + "1.0 2.0\n",
    "letters.xyz": text(BALL[:3000]).replace("0", "O", 1),
}


@pytest.mark.parametrize("command", ["build", "sections"])
@pytest.mark.parametrize("name", BAD)
def test_what_is_no_scan_of_a_blade_is_one_line_and_leaves_nothing(
    name: str, command: str, tmp_path: Path
):
    (tmp_path / name).write_text(BAD[name])
    output = tmp_path / ("out" if command == "build" else "out.csv")
    code, out, err = run(command, tmp_path / name, "-o", output)
    assert (code, out) == (2, "")
    assert re.fullmatch(rf"bladecad: {re.escape(name)}[^\n]+\n", err)
    assert "bug" not in err
    assert [path.name for path in tmp_path.iterdir()] == [name]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--model", "paper"], "--model paper is for sections, and scan.ply holds a scan"),
        (["--law", "linear"], "--law linear is for sections"),
        (["--spectrum", "varying"], "--spectrum varying is for sections"),
        (["--edges", "find"], "--edges find is for sections"),
        (["--stations", "1"], "1 stations; 4 to 201 are possible"),
        (["--cone", "20"], "about which axis"),
        (["--tolerance", "0"], "between 1e-6 and 10 mm"),
    ],
)
def test_options_that_are_not_for_scans_are_refused(arguments, message: str, scan, tmp_path: Path):
    code, out, err = run("build", scan, "-o", tmp_path / "out", *arguments)
    assert (code, out) == (2, "")
    assert message in err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "arguments",
    [["--span", "1:2"], ["--align"], ["--allow-partial"], ["--stations", "9"], ["--about", "z"],
     ["--cone", "5"], ["--axis", "1,0,0"]],
)  # fmt: skip
def test_options_that_are_for_scans_alone_are_refused_for_sections(arguments, tmp_path: Path):
    code, out, err = run("build", GOOD, "-o", tmp_path / "out", *arguments)
    assert (code, out) == (2, "")
    assert f"{arguments[0]}" in err
    assert "is for scans, and good.csv holds sections" in err
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "arguments",
    [["--span", "5"], ["--span", "5:1"], ["--span", "a:b"], ["--span", "1:2:3"],
     ["--axis", "w"], ["--axis", "0,0,0"], ["--axis", "1,0"], ["--axis", "nan,0,1"],
     ["--about", "q"], ["--stations", "many"], ["--cone", "wide"]],
)  # fmt: skip
def test_options_that_cannot_be_read_are_refused(arguments, scan, tmp_path: Path):
    code, out, err = run("build", scan, "-o", tmp_path / "out", *arguments)
    assert (code, out) == (2, "")
    assert err
    assert not list(tmp_path.iterdir())


def test_a_span_below_zero_and_an_axis_reach_the_reader(scan, tmp_path: Path, monkeypatch):
    asked = []

    def note(_path, settings, **_):
        asked.append(settings)
        raise KeyboardInterrupt

    monkeypatch.setattr(pipeline, "build_scan", note)
    code, *_ = run(
        "build", scan, "-o", tmp_path / "out", "--span", "-12.5:80", "--axis", "0,0,-1", "--align",
        "--about", "x", "--cone", "30", "--stations", "33", "--units", "in",
    )  # fmt: skip
    assert code == 130
    (settings,) = asked
    assert settings.span == (-12.5, 80.0)
    assert settings.direction.tolist() == [0.0, 0.0, -1.0]
    assert settings.height.kind == "cone"
    assert np.degrees(settings.height.half_angle) == pytest.approx(30.0)
    assert (settings.stations, settings.align) == (33, True)
    assert settings.unit == "in"


def test_a_pipe_sees_no_progress(tmp_path: Path):
    path = tmp_path / "ball.xyz"
    path.write_text(text(BALL[:5000]))
    command = [sys.executable, "-m", "bladecad", "build", str(path), "-o", str(tmp_path / "out")]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1
    assert done.stdout == ""


@pytest.fixture(scope="module")
def partial(tmp_path_factory) -> tuple[Path, int, str, str]:
    """The files of a scan of two blades, and what was said."""
    folder = tmp_path_factory.mktemp("partial")
    points = scan_of(truth_surface("synthetic-thick"), 30_000, sigma=SIGMA, seed=1).points
    points = np.concatenate([points, points[::2] + np.array([0.0, 25.0, 8.0])])
    (folder / "two.xyz").write_text(text(points))
    return folder, *run("build", folder / "two.xyz", "-o", folder / "out", "--allow-partial")


def test_two_blades_are_refused_and_the_option_is_named(partial, tmp_path: Path):
    folder, *_ = partial
    code, out, err = run("build", folder / "two.xyz", "-o", tmp_path / "out")
    assert (code, out) == (2, "")
    assert "two.xyz: the scan holds 2 blades; cut one out, or give --allow-partial" in err
    assert not list(tmp_path.iterdir())


def test_a_partial_blade_is_called_so_in_every_place(partial):
    folder, code, out, err = partial
    assert (code, err) == (0, "")
    assert out.splitlines()[-1] == "partial blade, within 10 um where it was measured"
    assert "note: the scan holds 2 blades: the one about" in out
    (line,) = [line for line in out.splitlines() if line.startswith("partial  ")]
    assert "one of 2 blades of the scan" in line
    report = json.loads((folder / "out" / "report.json").read_text())
    assert report["verdict"]["partial"]
    built, left = report["scan"]["partial"]["blades"]
    assert built["points"] == pytest.approx(30_000, rel=0.01)
    assert left["points"] == pytest.approx(15_000, rel=0.01)
    apart = np.subtract(left["centre_mm"], built["centre_mm"])
    assert apart == pytest.approx([0.0, 25.0, 8.0], abs=0.5)


def test_a_whole_blade_is_not_called_partial(aligned):
    folder, _, out, *_ = aligned
    assert "partial" not in out
    report = json.loads((folder / "report.json").read_text())
    assert report["verdict"]["partial"] is False
    assert report["scan"]["partial"] is None
