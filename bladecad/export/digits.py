"""Numbers and words as bytes, a million at a time; a table of them is text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Vector

Field: TypeAlias = NDArray[np.uint8]  # (k, w): one word a row; zero bytes are no text

ZERO, MINUS, POINT = (ord(c) for c in "0-.")
LARGEST: Final = 9e18  # of what an int64 holds


def decimals(x: Vector, digits: int) -> Field:
    """Write numbers with so many digits after the point, (k, w); NaN is an empty word.

    Raises
    ------
    OverflowError
        If a number is too long for 18 digits.
    """
    known = np.isfinite(x)
    scaled = np.rint(np.abs(np.where(known, x, 0.0)) * 10.0**digits)
    if scaled.max(initial=0.0) > LARGEST:
        raise OverflowError(f"{np.abs(x[known]).max():g} has no {digits} digits after the point")
    n = scaled.astype(np.int64)
    places = max(len(str(n.max(initial=0))), digits + 1)
    field = np.zeros((len(x), places + 2), np.uint8)
    field[:, 0] = np.where((n > 0) & (x < 0), MINUS, 0)
    for place in range(places):
        shown = known & ((n > 0) | (place <= digits))
        n, digit = np.divmod(n, 10)
        column = places + 1 - place - (place >= digits)
        field[:, column] = np.where(shown, digit + ZERO, 0)
    field[:, places + 1 - digits] = np.where(known, POINT, 0)
    return field


def words(table: Sequence[str], which: NDArray[np.integer]) -> Field:
    """Write a word of a table in every row, (k, w)."""
    encoded = [np.frombuffer(word.encode(), np.uint8) for word in table]
    field = np.zeros((len(table), max(map(len, encoded), default=0)), np.uint8)
    for row, word in zip(field, encoded, strict=True):
        row[: len(word)] = word
    return np.asarray(field[which])


def joined(fields: Sequence[Field]) -> bytes:
    """Join the words of every row by commas, and the rows by line ends."""
    k = len(fields[0])
    between = [np.full((k, 1), ord(c), np.uint8) for c in ",\n"]
    columns = [part for field in fields for part in (field, between[0])]
    table = np.concatenate([*columns[:-1], between[1]], axis=1)
    return bytes(table[table != 0])
