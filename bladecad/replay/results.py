"""All numbers of a replay, found side by side in two processes."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Final, final

import numpy as np

from bladecad.fit.blade import Order
from bladecad.one_thread import one_thread
from bladecad.pipeline import Settings
from bladecad.replay.blades import Known, default_blade, lines_of, others
from bladecad.replay.edge_modes import modal_fit
from bladecad.replay.homotopy import LAWS, PaperSurface, Sections, blended, paper_surface, studied
from bladecad.replay.ladder import RUNGS, Step, climbed
from bladecad.replay.layout import blade_length
from bladecad.replay.origin import Move, compared, moved
from bladecad.replay.plain import SPACINGS, Plain, plain
from bladecad.replay.subject import REGIONS, Region, Subject, subject
from bladecad.surface.blade import BladeSurface, Law

BEST: Final = Order(4, 4, 17)  # of the surface that stands beside the paper's
AS_THE_FILE_SAYS: Final = Settings()
Progress = Callable[[str], None]
Steps = list[Step]


@final
@dataclass(frozen=True, eq=False)
class Results:
    """What the figures show and the page tells.

    blade    : what was replayed
    subjects : its core and its whole
    plain    : the paper's fit of the suction lines: core and full, uniform and arc-length steps
    paper    : the paper's surface of the suction side, core and full
    modal    : bladecad's surface, by the law along the span
    """

    blade: Known
    subjects: dict[Region, Subject]
    plain: tuple[Plain, ...]
    paper: dict[Region, PaperSurface]
    modal: dict[Law, BladeSurface]
    laws: dict[Law, Sections]
    ladder: tuple[Step, ...]
    moves: tuple[Move, ...]

    @property
    def length(self) -> float:
        """From hub to tip, mm."""
        sides = [side.points for side in self.subjects["full"].sides]
        return blade_length(np.concatenate(sides, axis=1))


def replayed(
    path: Path | None = None,
    settings: Settings = AS_THE_FILE_SAYS,
    *,
    progress: Progress = lambda _: None,
) -> Results:
    """Replay the paper on a blade; on the default one, climb the ladder on all others too.

    Parameters
    ----------
    path : path, optional
        Any blade, with its own sections and points. By default Rotor 37, laid out as the paper's.
    settings : Settings
        How that file is read.
    progress : callable
        Told what is being done.
    """
    blade = default_blade() if path is None else Known(path.stem, path, settings=settings)
    return found(blade, others() if path is None else [], progress)


def found(blade: Known, beside: Sequence[Known], progress: Progress = lambda _: None) -> Results:
    """Find all numbers: the studies of one blade, and the ladder on it and on some others."""
    progress(f"{blade.name}: the paper's fit")
    with one_thread(), _two_processes() as pool:
        away = pool.submit(_moved, blade)
        steps = {b.name: pool.submit(_climbed, b) for b in (blade, *beside)}
        subjects = _subjects(blade)
        lines = [plain(s, spacing) for s in subjects.values() for spacing in SPACINGS]
        paper = {region: paper_surface(s.suction) for region, s in subjects.items()}
        fits = modal_fit(subjects["full"], BEST)
        modal = {law: blended(subjects["full"], fits, law) for law in LAWS}
        laws = {law: studied(surface) for law, surface in modal.items()}
        ladder: Steps = []
        for name, job in steps.items():
            progress(f"{name}: the ladder")
            ladder += job.result()
        moves = compared(ladder[: 2 * len(RUNGS)], away.result())
    return Results(blade, subjects, tuple(lines), paper, modal, laws, tuple(ladder), moves)


@contextmanager
def _two_processes() -> Iterator[ProcessPoolExecutor]:
    pool = ProcessPoolExecutor(2, mp_context=get_context("spawn"))
    try:
        yield pool
    finally:
        pool.shutdown(cancel_futures=True)


def _moved(blade: Known) -> Steps:
    with one_thread():
        return [step for s in _subjects(blade).values() for step in moved(s)]


def _climbed(blade: Known) -> Steps:
    with one_thread():
        return [step for s in _subjects(blade).values() for step in climbed(s)]


def _subjects(blade: Known) -> dict[Region, Subject]:
    lines = lines_of(blade)
    return {region: subject(blade.name, lines, region, blade.points) for region in REGIONS}
