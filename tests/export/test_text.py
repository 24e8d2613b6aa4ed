from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bladecad.errors import ExportError
from bladecad.export.text import to_json, write_json

FLOATS = st.floats(allow_nan=False, allow_infinity=False)
LEAVES = st.none() | st.booleans() | st.integers() | FLOATS | st.text()
VALUES = st.recursive(LEAVES, lambda v: st.lists(v) | st.dictionaries(st.text(), v), max_leaves=20)


@given(VALUES)
def test_json_read_back_is_what_was_written(value):
    assert json.loads(to_json(value)) == value


def test_arrays_are_lists_a_row_a_line():
    text = to_json({"A": np.arange(4.0).reshape(2, 2), "k": np.int64(3), "ok": np.bool_(True)})
    assert text == '{\n "A": [\n  [0.0, 1.0],\n  [2.0, 3.0]\n ],\n "k": 3,\n "ok": true\n}'


def test_what_is_not_finite_is_null():
    assert to_json([float("nan"), np.inf, np.float64("-inf"), 1.0]) == "[null, null, null, 1.0]"


def test_digits_are_those_asked_for():
    assert to_json([1 / 3, 7917.58808354595], digits=9) == "[0.333333333, 7917.58808]"


def test_a_file_that_cannot_be_written_leaves_nothing_beside(tmp_path: Path):
    (tmp_path / "x.json").mkdir()
    with pytest.raises(ExportError, match=r"x.json cannot be written"):
        write_json({}, tmp_path / "x.json")
    assert len(list(tmp_path.iterdir())) == 1
