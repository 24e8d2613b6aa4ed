"""What a finished check brings to its report; `bladecad.pipeline.Check` is one."""

from __future__ import annotations

from typing import Any, Protocol

from bladecad.deviation.inspecting.inspection import Inspection


class Checked(Protocol):
    """A scan measured against its nominal, with all that is known about it; names as in `Check`."""

    @property
    def name(self) -> str:
        """Of the blade."""

    @property
    def settings(self) -> Any:
        """What was asked for, a dataclass."""

    @property
    def inputs(self) -> Any:
        """What was read: what it is, to its file, SHA-256 and more."""

    @property
    def notes(self) -> tuple[str, ...]:
        """What was guessed, dropped or repaired on the way."""

    @property
    def inspection(self) -> Inspection:
        """Deviations, zones, sections, verdict."""
