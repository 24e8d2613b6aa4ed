"""What a partial blade leaves of a scan, or bridges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from bladecad.arrays import Vector, seal
from bladecad.scans.finding.one_sided import FREE, OneSided


@final
@dataclass(frozen=True, eq=False)
class Beside:
    """A blade of a scan with several.

    points : how many of the scan are nearest to it
    centre : (3,) float, mm, in the frame of the scan
    """

    points: int
    centre: Vector

    def __post_init__(self) -> None:
        seal(self, centre=(3,))

    def __str__(self) -> str:
        return "({})".format(", ".join(f"{x:.4g}" for x in self.centre))


@final
@dataclass(frozen=True, eq=False)
class Partial:
    """What of a scan was built, and what was not.

    blades : of the scan; the first was built
    sided  : where it shows one side alone
    """

    blades: tuple[Beside, ...]
    sided: OneSided

    @property
    def notes(self) -> tuple[str, ...]:
        """What was not built or not measured, a sentence each."""
        notes = []
        if len(self.blades) > 1:
            built, *left = self.blades
            others = ", ".join(str(one) for one in left)
            notes.append(
                f"the scan holds {len(self.blades)} blades: the one about {built} mm, with the "
                f"most points, was built; left are those about {others} mm"
            )
        for where, far in (("below", self.sided.below), ("above", self.sided.above)):
            if far:
                notes.append(
                    f"the scan goes on for {far:.4g} mm {where} what was built, with one side of "
                    "the blade alone; left out"
                )
        if self.sided.share > FREE:
            notes.append(
                f"{self.sided.share:.0%} of one side of the blade is missing; bridged smoothly, "
                "not measured"
            )
        return tuple(notes)
