"""STL as text, quickly: its words are taken out, and what is left are numbers."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Points
from bladecad.data.scan_text import chunks, numbers

WORDS: Final = (b"facet normal", b"outer loop", b"vertex", b"endloop", b"endfacet")
NAME = re.compile(rb"^\s*(end)?solid.*$", re.MULTILINE)
FACET: Final = 12  # numbers: a normal and three corners


def read_text_stl(path: Path) -> tuple[Points, NDArray[np.int64]] | None:
    """Return three points a triangle, and the triangles; None if it is written in another way."""
    parts = []
    for chunk in chunks(path, 0):
        text = chunk.lower()
        text = NAME.sub(b"", text) if b"solid" in text else text
        for word in WORDS:
            text = text.replace(word, b"")
        found = numbers(text) if text.strip() else np.empty(0)
        if found is None:
            return None
        parts.append(found)
    every = np.concatenate(parts)
    if len(every) % FACET or not len(every):
        return None
    points = every.reshape(-1, FACET)[:, 3:].reshape(-1, 3)
    return points, np.arange(len(points)).reshape(-1, 3)
