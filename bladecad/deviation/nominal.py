"""What is measured against: the skin of a blade, and the blade coordinates on it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from bladecad.surface.blade import BladeSurface


@final
@dataclass(frozen=True, eq=False)
class Nominal:
    """The blade as it should be.

    surface : BladeSurface, names side, u and t of every place; of a nominal that is a STEP or mesh
              file it is fitted to sections through it, of all others it is the skin itself
    """

    surface: BladeSurface


def nominal_of(surface: BladeSurface) -> Nominal:
    """Take a blade surface as the nominal."""
    return Nominal(surface)
