"""The unit of a scan: what the head of a file says, or what its size suggests."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Final

import numpy as np

from bladecad.arrays import Points
from bladecad.data.sections import MM_PER, Unit
from bladecad.data.table import UNITS

SMALLEST, LARGEST = 2.0, 2500.0  # mm, diagonal of what may be scanned: a blade and its root
TAIL: Final = 0.005  # of the points at either end of each axis, that may be outliers
LOOKED_AT: Final = 50_000  # points
_SAID = re.compile(
    r"\bunits?\b(?:\s+(?:is|are|of\s+lengths?))?\s*[:=]*\s*[\[(\"']?([a-z]+)|\bin\s+([a-z]{2,})\b"
)
_SINGULAR = {"millimetre": "mm", "centimetre": "cm", "centimetres": "cm", "metre": "m"}


def unit_said(lines: Iterable[str]) -> Unit | None:
    """Return the unit that the lines of a head agree on, as in `# units: mm` or `in inches`."""
    found: set[Unit] = set()
    for line in lines:
        for words in _SAID.findall(line.lower()):
            word = words[0] or words[1]
            unit = UNITS.get(_SINGULAR.get(word, word))
            found |= {unit} if unit else set()
    return found.pop() if len(found) == 1 else None


def unit_by_size(points: Points) -> tuple[Unit, float]:
    """Guess the unit of a scan from its size: mm, unless it would then be no thing to scan.

    Parameters
    ----------
    points : (k, 3) float
        In the unit of the file, finite.

    Returns
    -------
    unit : "m" if the scan is smaller than 2 mm in mm, and between 2 mm and 2.5 m in m; else "mm"
    size : its diagonal without outliers, in the unit of the file

    Notes
    -----
    Centimetres and inches cannot be told from millimetres by size: a blade of 5 cm and one of 5 mm
    are both usual.
    """
    some = points[:: max(len(points) // LOOKED_AT, 1)]
    low, high = np.quantile(some, [TAIL, 1.0 - TAIL], axis=0)
    size = float(np.linalg.norm(high - low))
    small = SMALLEST / MM_PER["m"] <= size < SMALLEST
    return ("m" if small else "mm"), size


def unit_note(unit: Unit, size: float) -> str:
    """Say what was guessed, and how to say otherwise."""
    if unit != "mm":
        return (
            f"the file does not say its unit, and is {size:.3g} long: {unit} is taken; "
            "--units says otherwise"
        )
    odd = "" if SMALLEST <= size <= LARGEST else f", though {size:.3g} mm is no blade"
    return f"the file does not say its unit: mm is taken{odd}; --units says otherwise"
