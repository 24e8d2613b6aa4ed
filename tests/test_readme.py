"""What the pages say is run, and is so."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

import bladecad
from bladecad.export.model.model_file import save
from tests.export.products import small

ROOT = Path(__file__).resolve().parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md")), ROOT / "exports" / "README.md"]


def blocks(page: str) -> list[str]:
    text = (ROOT / page).read_text(encoding="utf-8")
    return re.findall(r"^```python\n(.*?)^```", text, re.DOTALL | re.MULTILINE)


@pytest.fixture
def somewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder with fixtures/ in it."""
    (tmp_path / "fixtures").symlink_to(ROOT / "fixtures")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_blocks_of_the_readme_run_one_after_the_other(somewhere: Path, capsys):
    found = blocks("README.md")
    assert len(found) == 3
    names: dict = {}
    for block in found:
        exec(block, names)
    assert capsys.readouterr().out.startswith("True - ")
    assert names["deviation"].largest < 0.012
    assert names["points"].shape == (50, 200, 3)
    assert bladecad.read_step("rotor37.step").valid


def test_the_model_file_is_evaluated_by_the_lines_of_its_manual(somewhere: Path):
    surface = small().surface
    save(surface, "rotor37.json")
    names: dict = {}
    (block,) = blocks("docs/files.md")
    exec(block, names)
    expected = surface("suction", np.zeros(1), np.array([0.25]))[0, 0]
    np.testing.assert_allclose(names["X"], expected, rtol=0, atol=1e-6)
    for t in (0.0, 0.01, 0.5, 0.99, 1.0):
        z = names["state"](names["side"]["bases"][0], t)
        np.testing.assert_allclose(z, surface.suction.bases[0](np.array([t]))[0], atol=1e-6)


def test_the_readme_opens_with_the_two_commands():
    lines = (ROOT / "README.md").read_text(encoding="utf-8").splitlines()
    assert [line.split()[:2] for line in lines[2:4]] == [["make", "demo"], ["make", "test"]]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path):
    for link in re.findall(r"\]\(([^)#]+)[^)]*\)", page.read_text(encoding="utf-8")):
        assert link.startswith("https://") or (page.parent / link).exists(), link


def test_the_line_for_a_test_suite_runs(somewhere: Path, capsys):
    from tests.test_check import scanned

    surface = small().surface
    save(surface, "rotor37.json")
    np.savetxt("scan.xyz", scanned(surface, 0.01), fmt="%.6f")
    (block,) = blocks("docs/check.md")
    exec(block, {})
    assert capsys.readouterr().out.startswith("True ")
    assert (somewhere / "report" / "report.html").exists()
