"""The origin: the same blade moved by 100 mm, and what happens to each model."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from bladecad.replay.curves import Score
from bladecad.replay.ladder import RUNGS, Step, climbed
from bladecad.replay.subject import Region, Subject

MOVE: Final = np.array([0.0, 0.0, 100.0])  # mm; along the machine axis, where z = 0 is anywhere
STAYS: Final = 1e-3  # relative change of the largest error up to which a model does not care
MODELS: Final = tuple(name for name in RUNGS if "spline" not in name)


class Move(NamedTuple):
    """One model on the blade as it is in the file, and on the blade moved."""

    region: Region
    rung: str
    here: Score
    there: Score

    @property
    def stays(self) -> bool:
        """Whether the error is the same at both places."""
        return bool(np.isclose(self.there.median, self.here.median, rtol=STAYS, atol=0))


def moved(subject: Subject) -> list[Step]:
    """Climb the ladder on the blade moved."""
    return list(climbed(subject.moved(MOVE), MODELS))


def compared(here: Sequence[Step], there: Sequence[Step]) -> tuple[Move, ...]:
    """Put side by side what every model makes of the blade at both places."""
    at_home = {(step.region, step.rung): step.score for step in here}
    return tuple(
        Move(step.region, step.rung, at_home[step.region, step.rung], step.score) for step in there
    )
