"""The names of the faces of a blade, as they stand in the STEP file."""

from __future__ import annotations

from typing import Final, Literal, TypeAlias

FaceName: TypeAlias = Literal[
    "SUCTION_SIDE", "PRESSURE_SIDE", "HUB", "TIP", "LEADING_EDGE", "TRAILING_EDGE", "AIRFOIL"
]

SUCTION_SIDE: Final = "SUCTION_SIDE"
PRESSURE_SIDE: Final = "PRESSURE_SIDE"
HUB: Final = "HUB"
TIP: Final = "TIP"
LEADING_EDGE: Final = "LEADING_EDGE"
TRAILING_EDGE: Final = "TRAILING_EDGE"
AIRFOIL: Final = "AIRFOIL"  # both sides in one face


def expected_counts(around: int, hub: int, tip: int) -> tuple[int, int, int]:
    """Return vertices, edges and faces of a blade.

    around : how many faces lie side by side around it, not counting the ends
    hub, tip : into how many edges the outline of each end is divided

    Two sides that meet in round edges: 4, 6, 4.
    """
    return hub + tip, hub + tip + around, around + 2
