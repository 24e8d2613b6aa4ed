"""docs/paper.md says what a replay measures."""

import re
from pathlib import Path

import pytest

from bladecad.replay.page import page

DOCS = Path(__file__).resolve().parents[2] / "docs"
ROUNDING = 1e-5  # of a size: what is only rounding
NUMBER = re.compile(r"(?<![\w.])\d[\d.]*(?:e[+-]?\d+)?(?![\w.]*\w)")
DIVERGED = 1e4  # mm; a flow that has left the blade by so much tells its power of ten, no digits


def words(line):
    return NUMBER.sub("#", line)


def numbers(line):
    return [float(n.rstrip(".")) for n in NUMBER.findall(line)]


def is_of_a_blade_not_climbed(line):
    return line.startswith("| ") and line.count("|") == 10


def agree(line, stated):
    """Whether all numbers agree: to 5 %, powers of ten to one and a half of them."""
    pairs = zip(numbers(line), numbers(stated), strict=True)
    return all(
        a == b or (a > 0 and max(a, b) / min(a, b) < (30 if a > DIVERGED or a < ROUNDING else 1.05))
        for a, b in pairs
    )


def test_the_page_in_docs_states_what_is_measured(results):
    stated = (DOCS / "paper.md").read_text(encoding="utf-8").splitlines()
    measured = page(results, "paper/").splitlines()
    places = {words(line): i for i, line in enumerate(stated)}
    wrong = [m for m in measured if not any(words(m) == words(s) and agree(m, s) for s in stated)]
    assert wrong == []
    assert places.keys() - set(map(words, measured)) == {
        words(s) for s in stated if is_of_a_blade_not_climbed(s) and words(s) not in
        set(map(words, measured))
    }  # fmt: skip


def test_every_picture_of_the_page_is_there():
    text = (DOCS / "paper.md").read_text(encoding="utf-8")
    pictures = re.findall(r"\]\((paper/\w+\.png)\)", text)
    assert len(pictures) == 8
    assert all((DOCS / picture).is_file() for picture in pictures)


@pytest.mark.parametrize("text", ["{", "}", "inf", "nan"])
def test_nothing_is_left_unfilled(results, text):
    assert not re.search(rf"(?<!\w){re.escape(text)}(?!\w)", page(results))
