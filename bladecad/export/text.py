"""JSON that can be read: a row of numbers a line, no NaN, and a file that is whole or not there."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from bladecad.written import beside


def write_json(value: object, path: str | os.PathLike[str], *, digits: int = 17) -> None:
    """Write a value as JSON, beside first and then renamed.

    Parameters
    ----------
    value : object
        Mappings, sequences, arrays, numbers, text.
    path : path
    digits : int
        Significant digits of the numbers; 17 keep every bit.

    Raises
    ------
    ExportError
        If the file cannot be written.
    """
    with beside(path) as file:
        file.write_text(to_json(value, digits=digits) + "\n", encoding="utf-8")


def to_json(value: object, *, digits: int = 17) -> str:
    """Return a value as JSON; arrays as lists, NaN and infinity as null."""
    return _text(_plain(value, digits), "")


def _plain(value: object, digits: int) -> Any:
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist(), digits)
    if isinstance(value, Mapping):
        return {str(key): _plain(item, digits) for key, item in value.items()}
    if isinstance(value, str) or value is None or isinstance(value, bool | int):
        return value
    if isinstance(value, float):
        return float(f"{value:.{digits}g}") if math.isfinite(value) else None
    if isinstance(value, Sequence):
        return [_plain(item, digits) for item in value]
    return str(value)


def _text(value: Any, indent: str) -> str:
    """One line where nothing is nested, else one line an item."""
    inner = indent + " "
    if isinstance(value, dict) and _nested(value.values()):
        rows = [f"{_word(key)}: {_text(item, inner)}" for key, item in value.items()]
        return "{\n" + ",\n".join(inner + row for row in rows) + f"\n{indent}}}"
    if isinstance(value, list) and _nested(value):
        return "[\n" + ",\n".join(inner + _text(item, inner) for item in value) + f"\n{indent}]"
    return _word(value)


def _nested(items: Iterable[Any]) -> bool:
    return any(isinstance(item, dict | list) for item in items)


def _word(value: Any) -> str:
    return json.dumps(value, ensure_ascii=False)
