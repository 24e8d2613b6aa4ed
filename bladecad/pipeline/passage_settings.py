"""What is asked of a passage."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import final

from bladecad.data.sections import Unit
from bladecad.errors import ToleranceError
from bladecad.passage.trim import LIMIT


@final
@dataclass(frozen=True)
class PassageSettings:
    """What is asked of a passage; None leaves it to the file, or to what suits the blade.

    walls            : file of hub and shroud
    unit             : of that file, where it does not say
    blades           : in the row
    tip_gap, hub_gap : mm, 0 where the blade stands on the wall
    inlet, outlet    : mm along both walls, ahead of the leading and behind the trailing edge
    size, chord_error, growth, edge : of the triangles, as `Sizing`
    limit            : of the span, how far the surface may be continued to reach a wall
    """

    walls: Path | None = None
    unit: Unit | None = None
    blades: int | None = None
    tip_gap: float = 0.0
    hub_gap: float = 0.0
    inlet: float | None = None
    outlet: float | None = None
    size: float | None = None
    chord_error: float | None = None
    growth: float = 1.2
    edge: float | None = None
    limit: float = LIMIT

    def __post_init__(self) -> None:
        for name in ("tip_gap", "hub_gap"):
            if not 0.0 <= getattr(self, name) < math.inf:
                said = name.replace("_", " ")
                raise ToleranceError(f"a {said} of {getattr(self, name):g} mm is asked; 0 or more")
        if self.tip_gap > 0.0 and self.hub_gap > 0.0:
            raise ToleranceError(
                f"a hub gap of {self.hub_gap:g} mm and a tip gap of {self.tip_gap:g} mm are asked; "
                "a blade stands on one wall at least"
            )
        for name in ("inlet", "outlet"):
            value = getattr(self, name)
            if value is not None and not 0.0 < value < math.inf:
                raise ToleranceError(f"an {name} {value:g} mm away is asked; it must be above 0")
        if self.blades is not None and self.blades < 2:
            raise ToleranceError(f"{self.blades} blades are asked; a row has 2 at least")
