"""The files of a replay."""

import csv
import subprocess
import sys

import numpy as np
import pytest

from bladecad.replay import ink
from bladecad.replay.draw_errors import figure_4

FIGURES = [*(f"figure{i}" for i in range(1, 6)), "ladder", "homotopy", "origin"]


@pytest.fixture(scope="module")
def replay(fixtures, tmp_path_factory):
    """The command on a small blade with its own sections and points, its output in a pipe."""
    folder = tmp_path_factory.mktemp("replay") / "out"
    blade = fixtures / "broken" / "good.csv"
    command = [sys.executable, "-W", "error", "-m", "bladecad", "paper", blade, "-o", folder]
    return subprocess.run(command, capture_output=True, text=True), folder


def rows(folder, name):
    with (folder / f"{name}.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_the_command_is_silent_in_a_pipe_and_takes_any_blade(replay):
    run, folder = replay
    assert (run.returncode, run.stdout, run.stderr) == (0, "", "")
    text = (folder / "paper.md").read_text(encoding="utf-8")
    assert "repeated step by step on good:" in text
    assert "Rotor 37 in its running shape" not in text


@pytest.mark.parametrize("name", FIGURES)
def test_every_figure_is_png_svg_and_csv(replay, name):
    _, folder = replay
    assert (folder / f"{name}.png").read_bytes().startswith(b"\x89PNG")
    assert b"<svg" in (folder / f"{name}.svg").read_bytes()[:2000]
    assert rows(folder, name)


def test_a_folder_with_files_in_it_is_refused(replay, fixtures):
    blade, (_, folder) = fixtures / "broken" / "good.csv", replay
    command = [sys.executable, "-m", "bladecad", "paper", blade, "-o", folder]
    run = subprocess.run(command, capture_output=True, text=True)
    assert run.returncode == 2
    assert "is not empty" in run.stderr


def test_the_table_of_figure_4_is_what_was_measured(results, tmp_path):
    with ink.styled():
        figure_4(results, tmp_path)
    table = [row for row in rows(tmp_path, "figure4") if row["region"] == "core"]
    found = [float(row["arc-length"]) for row in table]
    np.testing.assert_allclose(found, results.plain[1].absolute, rtol=1e-9)


@pytest.mark.parametrize(
    ("value", "text"),
    [(np.inf, "diverges"), (1797.3, "1800"), (0.0123456, "0.0123"), (5.7e35, "6e35"), (0.0, "0")],
)
def test_lengths_read_as_one_says_them(value, text):
    assert ink.millimetres(value) == text
