from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from bladecad.errors import ExportError
from bladecad.export.stage import check_file, check_folder, staged


def fill(folder: Path, *names: str, force: bool = False) -> None:
    with staged(folder, force=force) as stage:
        for name in names:
            (stage / name).write_text(name)
        files = [{"file": name} for name in names]
        (stage / "report.json").write_text(json.dumps({"files": files}))


def fill_and_fail(folder: Path, error: type[BaseException]) -> None:
    with staged(folder, force=True) as stage:
        (stage / "y.step").write_text("y")
        raise error


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


@pytest.mark.parametrize("depth", ["out", "a/b/out"])
def test_files_appear_together_in_a_new_folder(depth: str, tmp_path: Path):
    fill(tmp_path / depth, "x.step")
    assert names(tmp_path / depth) == {"x.step", "report.json"}
    assert len(names(tmp_path)) == 1


def test_nothing_is_seen_before_all_is_written(tmp_path: Path):
    with staged(tmp_path / "out") as stage:
        (stage / "x.step").write_text("x")
        assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("error", [ValueError, KeyboardInterrupt, SystemExit])
@pytest.mark.parametrize("existing", [False, True])
def test_whatever_goes_wrong_the_folder_is_as_it_was(error, existing: bool, tmp_path: Path):
    out = tmp_path / "out"
    if existing:
        fill(out, "x.step")
    before = names(out) if existing else set()
    with pytest.raises(error):
        fill_and_fail(out, error)
    assert (names(out) if out.exists() else set()) == before
    assert names(tmp_path) == ({"out"} if existing else set())


def test_a_folder_in_use_is_kept(tmp_path: Path):
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(ExportError, match=r"is not empty and is kept as it is; .*--force"):
        fill(tmp_path, "x.step")
    assert names(tmp_path) == {"mine.txt"}


def test_an_empty_folder_is_filled(tmp_path: Path):
    fill(tmp_path, "x.step")
    assert names(tmp_path) == {"x.step", "report.json"}


def test_force_replaces_the_earlier_blade_and_nothing_else(tmp_path: Path):
    (tmp_path / "mine.txt").write_text("mine")
    fill(tmp_path, "x.step", "overview.png", force=True)
    fill(tmp_path, "y.step", "overview.png", force=True)
    assert names(tmp_path) == {"mine.txt", "y.step", "overview.png", "report.json"}


def test_a_report_that_names_other_places_removes_nothing_there(tmp_path: Path):
    out = tmp_path / "out"
    fill(out, "x.step")
    (tmp_path / "mine.txt").write_text("mine")
    report = {"files": [{"file": "../mine.txt"}, {"file": str(tmp_path / "mine.txt")}]}
    (out / "report.json").write_text(json.dumps(report))
    fill(out, "y.step", force=True)
    assert (tmp_path / "mine.txt").exists()


@pytest.mark.parametrize("content", ["", "{", "[]", '{"files": [1]}', '{"files": null}'])
def test_a_report_of_someone_else_is_replaced(content: str, tmp_path: Path):
    (tmp_path / "report.json").write_text(content)
    fill(tmp_path, "x.step", force=True)
    assert names(tmp_path) == {"x.step", "report.json"}


@pytest.mark.parametrize("place", ["file/out", "file"])
def test_a_folder_that_cannot_be_made_is_named(place: str, tmp_path: Path):
    (tmp_path / "file").write_text("a file")
    with pytest.raises(ExportError, match=r"cannot be written: .*name another folder"):
        check_folder(tmp_path / place)
    assert names(tmp_path) == {"file"}


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_closed_to_us_is_named(tmp_path: Path):
    (tmp_path / "closed").mkdir(mode=0o500)
    with pytest.raises(ExportError, match="Permission denied"):
        check_folder(tmp_path / "closed" / "out")


def test_files_are_kept_too(tmp_path: Path):
    file = tmp_path / "m.json"
    check_file(file)
    file.write_text("mine")
    with pytest.raises(ExportError, match=r"m.json exists and is kept as it is; .*--force"):
        check_file(file)
    check_file(file, force=True)
    with pytest.raises(ExportError, match="is a folder"):
        check_file(tmp_path, force=True)
    with pytest.raises(ExportError, match="there is no folder"):
        check_file(tmp_path / "none" / "m.json")


def test_a_report_of_another_kind_is_not_replaced_nor_what_it_names(tmp_path: Path):
    folder = tmp_path / "out"
    folder.mkdir()
    said = {"schema": "bladecad-report/1", "files": [{"file": "blade.step"}]}
    (folder / "report.json").write_text(json.dumps(said))
    (folder / "blade.step").write_text("solid")
    again = "is a bladecad-report, and would be replaced by a bladecad-check"
    with pytest.raises(ExportError, match=again), staged(folder, force=True) as stage:
        (stage / "report.json").write_text(json.dumps({"schema": "bladecad-check/1"}))
    assert (folder / "blade.step").read_text() == "solid"
    assert json.loads((folder / "report.json").read_text()) == said


def test_files_under_another_report_are_left_alone(tmp_path: Path):
    folder = tmp_path / "out"
    folder.mkdir()
    said = {"schema": "bladecad-report/1", "files": [{"file": "blade.step"}]}
    (folder / "report.json").write_text(json.dumps(said))
    (folder / "blade.step").write_text("solid")
    with staged(folder, force=True, report="cam.json") as stage:
        (stage / "cam.json").write_text(json.dumps({"schema": "bladecad-cam/1"}))
    assert {p.name for p in folder.iterdir()} == {"report.json", "blade.step", "cam.json"}
