"""Which format a CAD file has, told by its suffix, before any kernel is loaded."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Final, Literal

from bladecad.errors import ExportError

CAD: Final[Mapping[str, Literal["STEP", "IGES", "BREP"]]] = {
    ".step": "STEP",
    ".stp": "STEP",
    ".igs": "IGES",
    ".iges": "IGES",
    ".brep": "BREP",
}


def cad_format(path: str | os.PathLike[str]) -> Literal["STEP", "IGES", "BREP"]:
    """Return the format of a suffix, in capitals or not.

    Raises
    ------
    ExportError
        If it is none of .step, .stp, .igs, .iges and .brep.
    """
    suffix = Path(path).suffix.lower()
    if suffix not in CAD:
        raise ExportError(
            f'{Path(path).name}: "{suffix}" is no CAD format; known are {", ".join(CAD)}, and .stl'
        )
    return CAD[suffix]
