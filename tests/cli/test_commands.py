from __future__ import annotations

import io
import json
import logging
import re
import subprocess
import sys
from pathlib import Path
from typing import get_args

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

import bladecad
from bladecad.cli import app, options
from bladecad.cli.console import log_to_stderr, progress
from bladecad.curves.naming import Hand, Lead
from bladecad.curves.sides import Edges
from bladecad.data.read import read_sections
from bladecad.data.sections import Axis, Unit
from bladecad.fit.blade import ModelName, Order, SpectrumKind
from bladecad.surface.blade import Law
from tests.export.products import FIXTURES, GOOD

COMMANDS = tuple(typer.main.get_command(app).commands)
CHOICES = [
    (options.ModelChoice, ModelName),
    (options.SpectrumChoice, SpectrumKind),
    (options.LawChoice, Law),
    (options.UnitChoice, Unit),
    (options.AxisChoice, Axis),
    (options.LeadChoice, Lead),
    (options.HandChoice, Hand),
    (options.EdgesChoice, Edges),
]


def run(*arguments: object) -> tuple[int, str, str]:
    result = CliRunner().invoke(app, [str(a) for a in arguments], catch_exceptions=False)
    return result.exit_code, result.stdout, result.stderr


@pytest.mark.parametrize(("asked", "known"), CHOICES)
def test_choices_are_those_of_the_library(asked, known):
    assert set(get_args(asked)) == set(get_args(known))


@pytest.mark.parametrize("command", ["", *COMMANDS])
def test_help_loads_nothing_heavy(command: str):
    """So that it answers at once; `make bench` holds it to half a second."""
    code = (
        "import sys\nfrom contextlib import suppress\nfrom bladecad.cli import main\n"
        f"sys.argv = ['bladecad', *{command.split()!r}, '--help']\n"
        "with suppress(SystemExit):\n    main()\n"
        "assert not {'numpy', 'scipy', 'cadquery', 'trimesh', 'matplotlib'} & sys.modules.keys()"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr


def test_the_version_is_told():
    assert run("--version") == (0, f"bladecad {bladecad.__version__}\n", "")


@pytest.mark.parametrize(
    "arguments",
    [
        ["build", GOOD],
        ["build", GOOD, "-o", "x", "--order", "3,3"],
        ["build", GOOD, "-o", "x", "--order", "0,3,11"],
        ["build", GOOD, "-o", "x", "--order", "3,3,99"],
        ["build", GOOD, "-o", "x", "--model", "neural"],
        ["build", GOOD, "-o", "x", "--units", "furlong"],
        ["build", GOOD, "-o", "x", "--name", "../x"],
        ["build", GOOD, "-o", "x", "--name", ""],
        ["build", GOOD, "-o", "x", "--tolerance", "little"],
        ["build", GOOD, "-o", "x", "--tolerance", "0"],
        ["build", GOOD, "-o", "x", "--chord-error", "-1"],
        ["build", "none.csv", "-o", "x"],
        ["paint", GOOD],
    ],
)
def test_wrong_usage_has_code_2_and_writes_nothing(arguments, tmp_path: Path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, out, err = run(*arguments)
    assert code == 2
    assert out == ""
    assert err
    assert not list(tmp_path.iterdir())


def test_an_order_is_read_as_it_is_printed():
    assert options.parse_order("4, 5,17") == Order(4, 5, 17)


def test_fit_writes_the_model_and_keeps_what_exists(tmp_path: Path):
    model = tmp_path / "m.json"
    code, out, err = run("fit", GOOD, "-o", model)
    assert (code, err) == (0, "")
    assert "order" in out
    surface = bladecad.load(model)
    assert surface.suction.coefficients.shape[0] == 4
    code, _, err = run("fit", GOOD, "-o", model)
    assert code == 2
    assert "--force" in err
    assert run("fit", GOOD, "-o", model, "--force", "--quiet") == (0, "within 10 um\n", "")


def test_a_fixed_order_is_written_even_where_it_falls_short(tmp_path: Path):
    model = tmp_path / "m.json"
    code, out, _ = run("fit", GOOD, "-o", model, "--order", "1,1,3", "--tolerance", "0.001")
    assert code == 1
    assert "out of tolerance" in out
    order = json.loads(model.read_text())["provenance"]["order"]
    assert order == {"le": 1, "te": 1, "degree": 3, "knots": 0}


def test_a_fit_that_no_order_meets_writes_no_model(tmp_path: Path):
    code, out, err = run("fit", GOOD, "-o", tmp_path / "m.json", "--tolerance", "1e-5")
    assert (code, err) == (1, "")
    assert "no order meets 0.01 um" in out
    assert not list(tmp_path.iterdir())


def test_info_tells_a_blade_as_text_and_as_json():
    code, text, _ = run("info", GOOD)
    assert code == 0
    assert "chord" in text
    code, text, _ = run("info", GOOD, "--json")
    assert code == 0
    assert [section["name"] for section in json.loads(text)["sections"]] == ["1", "2", "3", "4"]


def test_options_reach_the_reader():
    _, text, _ = run("info", GOOD, "--json", "--suction", "left", "--le", "high", "--axis", "y")
    found = json.loads(text)
    assert found["axis"] == "y"
    assert found["axis_from"] == "option"


@pytest.mark.parametrize("suffix", [".csv", ".curve", ".xyz", ".ibl"])
def test_convert_keeps_the_points(suffix: str, tmp_path: Path):
    output = tmp_path / f"blade{suffix}"
    code, out, _ = run("convert", GOOD, output)
    assert code == 0
    assert "4 sections" in out
    pairs = zip(read_sections(GOOD).sections, read_sections(output).sections, strict=True)
    for before, after in pairs:
        same = np.linalg.norm(before.points[:, None] - after.points, axis=2).min(axis=1)
        assert same.max() < 1e-5


def test_convert_keeps_what_exists_and_refuses_what_it_cannot_write(tmp_path: Path):
    (tmp_path / "x.csv").write_text("mine")
    assert run("convert", GOOD, tmp_path / "x.csv")[0] == 2
    assert (tmp_path / "x.csv").read_text() == "mine"
    assert run("convert", GOOD, tmp_path / "x.csv", "--force", "--quiet") == (0, "", "")
    code, _, err = run("convert", GOOD, tmp_path / "x.dwg")
    assert code == 2
    assert '".dwg"; choose one of .csv' in err
    assert run("convert", FIXTURES / "broken" / "nan.csv", tmp_path / "y.csv")[0] == 2
    assert [path.name for path in tmp_path.iterdir()] == ["x.csv"]


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_a_terminal_sees_each_step(monkeypatch):
    monkeypatch.setattr(sys, "stderr", Terminal())
    with progress(quiet=False) as tell:
        tell("order 4, 5, 17")
    assert "order 4, 5, 17" in sys.stderr.getvalue()


@pytest.mark.parametrize(("stream", "quiet"), [(Terminal(), True), (io.StringIO(), False)])
def test_nobody_else_does(stream, quiet: bool, monkeypatch):
    monkeypatch.setattr(sys, "stderr", stream)
    with progress(quiet=quiet) as tell:
        tell("read")
    assert stream.getvalue() == ""


def test_verbose_turns_the_log_on(monkeypatch):
    asked = []
    monkeypatch.setattr(logging, "basicConfig", lambda **options: asked.append(options["level"]))
    log_to_stderr(False)
    log_to_stderr(True)
    assert asked == [logging.INFO]


@pytest.mark.parametrize("command", COMMANDS)
def test_every_option_stands_in_the_manual(command: str):
    manual = (FIXTURES.parent / "docs" / "cli.md").read_text(encoding="utf-8")
    _, text, _ = run(command, "--help")
    for option in set(re.findall(r"--[a-z-]+", text)) - {"--help"}:
        assert f"`{option}" in manual
