"""The public names are those in `bladecad.__all__`, and no others."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import bladecad

TREE = ast.parse(Path(bladecad.__file__).read_text(encoding="utf-8"))


def typed() -> list[tuple[str, str]]:
    """Home and name of what type checkers see."""
    nodes = [node for node in ast.walk(TREE) if isinstance(node, ast.ImportFrom)]
    return [
        (str(node.module).removeprefix("bladecad."), alias.asname)
        for node in nodes
        for alias in node.names
        if alias.asname
    ]


def test_the_public_names_are_sorted_and_said_once():
    assert bladecad.__all__ == sorted(set(bladecad.__all__))


def test_type_checkers_and_users_find_them_in_the_same_place():
    homes = [(home, name) for home, names in bladecad._HOMES.items() for name in names]
    assert sorted(homes) == sorted(typed())
    assert sorted([*(name for _, name in homes), "__version__"]) == bladecad.__all__
    assert list(bladecad._HOMES) == sorted(bladecad._HOMES)


@pytest.mark.parametrize("name", sorted(set(bladecad.__all__) - {"__version__"}))
def test_every_name_is_there_and_explained(name: str):
    assert getattr(bladecad, name).__doc__
    assert getattr(bladecad, name) is getattr(bladecad, name)


def test_no_public_name_hides_a_room_of_the_house():
    rooms = {path.stem for path in Path(bladecad.__file__).parent.iterdir()}
    assert not rooms & set(bladecad.__all__)


def test_other_names_are_not_there():
    with pytest.raises(AttributeError, match="module 'bladecad' has no attribute 'blade'"):
        _ = bladecad.blade
    assert dir(bladecad) == bladecad.__all__
