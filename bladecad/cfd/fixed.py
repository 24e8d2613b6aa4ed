"""Numbers as text of one width, a million at a time, and back."""

from __future__ import annotations

from typing import Final, TypeAlias

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array
from bladecad.errors import ExportError

Text: TypeAlias = NDArray[np.uint8]  # (..., w): one number a row, filled up with blanks

BLANK, MINUS, POINT, ZERO = (ord(c) for c in " -.0")
LARGEST: Final = 9e15  # a float64 counts so far


def scaled(x: Array, digits: int) -> NDArray[np.int64]:
    """Numbers as integers, in units of the last digit that is written.

    Raises
    ------
    ExportError
        If a number has more than 15 digits.
    """
    largest = float(np.abs(x).max(initial=0.0))
    if not largest * 10.0**digits < LARGEST:
        raise ExportError(f"{largest:g} cannot be written with {digits} digits after the point")
    return np.rint(x * 10.0**digits).astype(np.int64)


def fixed(numbers: NDArray[np.int64], digits: int) -> Text:
    """Write scaled integers with so many digits after the point, (..., w), right-aligned."""
    size = np.abs(numbers)
    places = max(len(str(size.max(initial=0))), digits + 1)
    text = np.full((*numbers.shape, places + 2), BLANK, np.uint8)
    for place in range(places):
        column = places + 1 - place - (place >= digits)
        shown = (size > 0) | (place <= digits)
        rest = size // 10
        text[..., column] = np.where(shown, size - 10 * rest + ZERO, BLANK)
        size = rest
    text[..., places + 1 - digits] = POINT
    ahead = np.argmax(text != BLANK, axis=-1) - 1
    negative = numbers < 0
    text[(*np.nonzero(negative), ahead[negative])] = MINUS
    return text


def parsed(text: Text) -> NDArray[np.int64]:
    """The scaled integers again: the digits, without the point.

    Raises
    ------
    ExportError
        If there is anything but blanks, digits, one sign and one point.
    """
    value, negative = np.zeros(text.shape[:-1]), np.zeros(text.shape[:-1], bool)
    for column in np.moveaxis(text, -1, 0).copy():
        is_digit = (column >= ZERO) & (column < ZERO + 10)
        minus = column == MINUS
        if not np.all(is_digit | minus | (column == BLANK) | (column == POINT)):
            raise ExportError("what was read back is no number")
        if is_digit.all():
            value = 10.0 * value + (column - ZERO)
        elif is_digit.any():
            value = np.where(is_digit, 10.0 * value + (column - ZERO), value)
        negative |= minus
    return np.where(negative, -value, value).astype(np.int64)
