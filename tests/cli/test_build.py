from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import trimesh
from typer.testing import CliRunner

import bladecad
from bladecad import pipeline
from bladecad.cli import app
from bladecad.errors import FitError, GeometryError
from tests.export.products import FIXTURES, GOOD, coarse, small

BROKEN = FIXTURES / "broken"
REFUSED = {
    "blade.foo": r"blade.foo holds no points; export the scan again",  # the head of an STL
    "empty.csv": r"empty.csv is empty; export the sections again",
    "gap.csv": r'section "2": a gap of .* between points 12 and 13, .*measure the missing points',
    "missing_cell.csv": r'missing_cell.csv, line 40: column "z" is empty; complete the row',
    "missing_column.csv": r'missing_column.csv, line 2: no column "z", .*add it',
    "nan.csv": r'nan.csv, line 90: "nan" is not finite; measure this point again',
    "one_section.csv": r"one_section.csv: 1 section .*give all sections",
    "rubbish.bin": r"rubbish.bin is not text .*offset 6.*export them as CSV",
    "rubbish.csv": r"rubbish.csv: .*a plain table needs the header",
    "self_crossing.csv": r'section "2": the outline crosses itself .*sort or remove them',
    "text_in_number.csv": r'text_in_number.csv, line 40: "12.3.4O5" is no number; correct it',
    "three_points.csv": r'three_points.csv: section "2" has 3 points, .*measure it again',
    "wrong_units.csv": r"wrong_units.csv: the blade is 95.25 m large, .*try --units mm",
}
REPAIRED = {
    "duplicated_points.csv": 'section "2": 2 points repeated, dropped',
    "flipped_section.csv": 'the other way round than most: section "2"; put right',
    "out_of_order.csv": 'out of order along the span: section "3"; sorted',
    "readable.foo": "read as table of points, from its content",
    "spike.csv": 'section "2", point 16: -1.07 mm off the line of its neighbours',
    "swapped_sides.csv": 'section "2": suction and pressure side were swapped',
}


def run(*arguments: object) -> tuple[int, str, str]:
    """Exit code, stdout and stderr of a command."""
    result = CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)
    return result.exit_code, result.stdout, result.stderr


@pytest.fixture
def built(monkeypatch: pytest.MonkeyPatch):
    """Let `build` give a finished blade, or raise, instead of building one."""

    def use(outcome: object) -> None:
        def build(*_: object, **__: object) -> object:
            if isinstance(outcome, BaseException):
                raise outcome
            return outcome

        monkeypatch.setattr(pipeline, "build", build)

    return use


def test_every_broken_file_is_spoken_for():
    files = {path.name for path in BROKEN.iterdir()} - {"good.csv", "good_sides.csv"}
    assert files == REFUSED.keys() | REPAIRED.keys()


@pytest.mark.parametrize("name", REFUSED)
def test_bad_input_is_one_line_with_the_place_and_what_to_do(name: str, tmp_path: Path):
    code, out, err = run("build", BROKEN / name, "-o", tmp_path / "out")
    assert code == 2
    assert out == ""
    assert err.startswith("bladecad: ")
    assert err.count("\n") == 1
    assert re.search(REFUSED[name], err)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", REPAIRED)
def test_what_is_repaired_is_told(name: str):
    code, out, _ = run("info", BROKEN / name)
    assert code == 0
    assert REPAIRED[name] in " ".join(out.split())


def test_rotor_37_is_built_and_every_file_is_good(tmp_path: Path):
    out_folder = tmp_path / "rotor37"
    code, out, err = run(
        "build", FIXTURES / "rotor37" / "sections.csv", "-o", out_folder, "--tolerance", 0.012,
        "--name", "rotor37",
    )  # fmt: skip
    assert (code, err) == (0, "")
    assert out.splitlines()[-1] == "within 12 um"
    step = bladecad.read_step(out_folder / "rotor37.step")
    assert step.valid
    assert step.solids == 1
    assert (out_folder / "rotor37.step").stat().st_size < 400_000
    mesh = trimesh.load_mesh(out_folder / "rotor37.stl")
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(step.volume, rel=1e-4)
    surface = bladecad.load(out_folder / "rotor37.json")
    assert np.isfinite(surface("suction", surface.span, surface.span)).all()
    report = json.loads((out_folder / "report.json").read_text())
    assert report["verdict"]["within"]
    assert report["fit"]["max_mm"] <= 0.012
    assert report["solid"]["step_read_back"]["volume_error"] < 1e-6
    assert (out_folder / "overview.png").read_bytes().startswith(b"\x89PNG")


def test_a_blade_out_of_tolerance_is_written_marked_and_has_code_1(built, tmp_path: Path):
    built(coarse())
    code, out, err = run("build", GOOD, "-o", tmp_path / "out")
    assert (code, err) == (1, "")
    assert out.splitlines()[-1].startswith("out of tolerance: ")
    assert coarse().reasons[0] in out
    report = json.loads((tmp_path / "out" / "report.json").read_text())
    assert not report["verdict"]["within"]
    assert len(list((tmp_path / "out").iterdir())) == 5


def test_where_no_fit_meets_the_tolerance_the_report_stands_alone(built, tmp_path: Path):
    built(FitError("no order meets 1 um", best=coarse().fit))
    code, out, err = run("build", GOOD, "-o", tmp_path / "out")
    assert (code, err) == (1, "")
    assert out.splitlines()[-1] == "out of tolerance: no order meets 1 um"
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["report.json"]
    report = json.loads((tmp_path / "out" / "report.json").read_text())
    assert report["fit"]["max_mm"] == pytest.approx(coarse().fit.errors.largest)


def test_a_failure_takes_the_earlier_blade_away_with_its_report(built, tmp_path: Path):
    built(small())
    run("build", GOOD, "-o", tmp_path)
    built(FitError("no order meets 1 um", best=coarse().fit))
    assert run("build", GOOD, "-o", tmp_path, "--force")[0] == 1
    assert [path.name for path in tmp_path.iterdir()] == ["report.json"]


@pytest.mark.parametrize(
    ("error", "code", "message"),
    [
        (FitError("the flow diverges"), 2, "bladecad: the flow diverges\n"),
        (GeometryError("two\n  lines"), 2, "bladecad: two lines\n"),
        (KeyboardInterrupt(), 130, "bladecad: interrupted; nothing was written\n"),
        (ZeroDivisionError("x"), 70, "bladecad: unexpected ZeroDivisionError: x; this is a bug"),
    ],
)
def test_errors_become_a_line_and_a_code_and_leave_nothing(
    error, code: int, message: str, built, tmp_path: Path
):
    built(error)
    found, out, err = run("build", GOOD, "-o", tmp_path / "out")
    assert (found, out) == (code, "")
    assert err.startswith(message)
    assert not list(tmp_path.iterdir())


def test_output_that_exists_is_kept_unless_forced(built, tmp_path: Path):
    built(small())
    (tmp_path / "good.step").write_text("mine")
    code, _, err = run("build", GOOD, "-o", tmp_path)
    assert code == 2
    assert "is not empty and is kept as it is" in err
    assert "--force" in err
    assert [path.read_text() for path in tmp_path.iterdir()] == ["mine"]
    assert run("build", GOOD, "-o", tmp_path, "--force")[0] == 0
    assert (tmp_path / "good.step").read_text().startswith("ISO-10303-21")


def test_output_is_refused_before_anything_is_read(built, tmp_path: Path):
    built(AssertionError("too late"))
    (tmp_path / "x").write_text("mine")
    assert run("build", GOOD, "-o", tmp_path)[0] == 2


@pytest.mark.parametrize("place", ["file", "file/out"])
def test_a_folder_that_cannot_be_written_is_named(place: str, tmp_path: Path):
    (tmp_path / "file").write_text("a file")
    code, _, err = run("build", GOOD, "-o", tmp_path / place)
    assert code == 2
    assert "cannot be written" in err
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_closed_to_us_is_named(tmp_path: Path):
    (tmp_path / "closed").mkdir(mode=0o500)
    code, _, err = run("build", GOOD, "-o", tmp_path / "closed" / "out")
    assert code == 2
    assert "Permission denied" in err


def test_the_quiet_hear_the_verdict_alone(built, tmp_path: Path):
    built(small())
    assert run("build", GOOD, "-o", tmp_path, "--quiet") == (0, "within 10 um\n", "")


def test_what_is_printed_is_what_stands_in_the_report(built, tmp_path: Path):
    built(small())
    _, out, _ = run("build", GOOD, "-o", tmp_path / "fan", "--name", "fan 7")
    report = json.loads((tmp_path / "fan" / "report.json").read_text())
    for note in report["input"]["notes"]:
        assert f"note: {note}" in out
    for entry in report["files"]:
        assert entry["file"] in out
    heads = {line.split("  ")[0] for line in out.splitlines()}
    assert {"blade", "order", "fit", "left out", "deviation", "referee", "B-rep to S",
            "witnesses", "triangles", "files", "in"} <= heads  # fmt: skip
    assert "fan 7: 4 sections, 240 points" in out


def test_a_pipe_carries_the_numbers_and_no_progress(tmp_path: Path):
    command = [sys.executable, "-m", "bladecad", "fit", str(GOOD), "-o", str(tmp_path / "m.json")]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stderr == ""
    assert done.stdout.splitlines()[-1] == "within 10 um"
    assert "\x1b" not in done.stdout
