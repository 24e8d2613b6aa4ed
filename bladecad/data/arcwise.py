"""Tables `X  R*THETA  R`, as NASA published its HECC compressor: one loop a file.

X is the machine axis. NASA counts theta positive counter-clockwise when looking aft, along x, which
is left-handed; in space the sections stand about z, right-handed. NASA's inches are in no file.
"""

from __future__ import annotations

import re

import numpy as np

from bladecad.data import beside
from bladecad.data.blocks import blocks
from bladecad.data.draft import Draft
from bladecad.data.loops import loop
from bladecad.data.table import header_of, read_table
from bladecad.data.text import Text, table
from bladecad.errors import DataError

COLUMNS = ("x", "r*theta", "r")


def recognises(text: Text) -> bool:
    """Whether the header names x, r*theta and r."""
    words = [re.split(r"[_ (\[]", word)[0] for word in header_of(text)[1]]
    return sorted(words) == sorted(COLUMNS)


def read(text: Text) -> Draft:
    """Read the one section of a file; without a header the columns stand in the usual order."""
    columns = read_table(text) if recognises(text) else None
    rows = columns.values(*COLUMNS) if columns else table(text, blocks(text)[0].rows)
    x, arc, r = rows.T
    if np.any(r <= 0):
        raise DataError(
            f"{text.path.name}: point {int(np.argmin(r)) + 1} has radius {r.min():g}, it must be "
            "positive; are the columns X, R*THETA, R?"
        )
    points = np.column_stack([r * np.cos(arc / r), -r * np.sin(arc / r), x])
    hub, shroud = beside.loose_curves(text.path)
    return Draft(
        "R*THETA table",
        (loop(text.path.stem, points),),
        unit=columns.unit(*COLUMNS) if columns else None,
        axis="z",
        hub=hub,
        shroud=shroud,
        cylindrical=True,
        usual="in",
    ).noted("theta is taken as counter-clockwise looking aft, as NASA counts it for HECC")
