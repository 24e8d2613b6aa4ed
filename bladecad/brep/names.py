"""The names of the faces of a blade, as they stand in the STEP file."""

from __future__ import annotations

from typing import Final, Literal, TypeAlias

FaceName: TypeAlias = Literal[
    "SUCTION_SIDE", "PRESSURE_SIDE", "HUB", "TIP", "LEADING_EDGE", "TRAILING_EDGE"
]

SUCTION_SIDE: Final = "SUCTION_SIDE"
PRESSURE_SIDE: Final = "PRESSURE_SIDE"
HUB: Final = "HUB"
TIP: Final = "TIP"
LEADING_EDGE: Final = "LEADING_EDGE"
TRAILING_EDGE: Final = "TRAILING_EDGE"


def expected_counts(faces: int) -> tuple[int, int, int]:
    """Return vertices, edges and faces of a blade: 4, 6, 4 and 2, 3, 1 more a blunt edge."""
    blunt = faces - 4
    return 4 + 2 * blunt, 6 + 3 * blunt, faces
