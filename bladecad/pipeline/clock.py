"""What each step is called, and how long it takes."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import perf_counter
from typing import final

from bladecad.one_thread import one_thread

Progress = Callable[[str], None]


@final
class Clock:
    """Wall time of each step, told as it begins; each runs in one thread."""

    def __init__(self, progress: Progress) -> None:
        self.progress = progress
        self.seconds: dict[str, float] = {}

    @contextmanager
    def step(self, name: str) -> Iterator[None]:
        """Time one step."""
        self.progress(name)
        start = perf_counter()
        with one_thread():
            yield
        self.seconds[name] = perf_counter() - start
