"""The files of a replay."""

import csv
import os
import subprocess
import sys

import numpy as np
import pytest

from bladecad.replay import ink
from bladecad.replay.write import write

FIGURES = [*(f"figure{i}" for i in range(1, 6)), "ladder", "homotopy", "origin"]


@pytest.fixture(scope="module")
def folder(results, tmp_path_factory):
    path = tmp_path_factory.mktemp("paper")
    write(results, path)
    return path


def rows(folder, name):
    with (folder / f"{name}.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize("name", FIGURES)
def test_every_figure_is_png_svg_and_csv(folder, name):
    assert (folder / f"{name}.png").read_bytes().startswith(b"\x89PNG")
    assert b"<svg" in (folder / f"{name}.svg").read_bytes()[:2000]
    assert rows(folder, name)


def test_the_table_of_figure_4_is_what_was_measured(folder, results):
    table = [r for r in rows(folder, "figure4") if r["region"] == "core"]
    found = [float(r["arc-length"]) for r in table]
    np.testing.assert_allclose(found, results.plain[1].absolute, rtol=1e-9)


def test_the_table_of_figure_1_holds_every_point(folder):
    assert len(rows(folder, "figure1")) == 2 * 2 * 15 * 71


@pytest.mark.parametrize(
    ("value", "text"),
    [(np.inf, "diverges"), (1797.3, "1800"), (0.0123456, "0.0123"), (5.7e35, "6e35"), (0.0, "0")],
)
def test_lengths_read_as_one_says_them(value, text):
    assert ink.millimetres(value) == text


def test_the_command_is_silent_in_a_pipe_and_takes_any_blade(tmp_path, fixtures):
    blade = str(fixtures / "broken" / "good.csv")
    command = [
        sys.executable,
        "-W",
        "error",
        "-m",
        "bladecad",
        "paper",
        blade,
        "-o",
        str(tmp_path / "out"),
    ]
    run = subprocess.run(command, capture_output=True, text=True, env=os.environ)
    assert (run.returncode, run.stdout, run.stderr) == (0, "", "")
    assert {f"{n}.png" for n in FIGURES} | {"paper.md"} <= {
        p.name for p in (tmp_path / "out").iterdir()
    }
