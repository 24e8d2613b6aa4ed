"""The ladder: what each improvement buys, from the paper's first fit to bladecad's own."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import Final, NamedTuple

from bladecad.fit.blade import Order
from bladecad.fit.differences import Model, Scheme
from bladecad.fit.steps import Spacing
from bladecad.replay.curves import Curves, Score, score
from bladecad.replay.edge_modes import modal, size, spline
from bladecad.replay.matched import matched
from bladecad.replay.quadratic import quadratic
from bladecad.replay.segments import segmented
from bladecad.replay.subject import Region, Stretch, Subject
from bladecad.replay.trajectory import on_trajectory

Sides = tuple[Curves, Curves]
Rung = Callable[[Subject], Sides]
ORDERS: Final = (Order(1, 1, 5), Order(2, 2, 9), Order(3, 3, 13), Order(4, 4, 17))
SEGMENTS: Final = 8


class Step(NamedTuple):
    """One rung on one blade.

    coefficients : a section, side and coordinate; of the paper's models their share of A and z0
    """

    blade: str
    region: Region
    rung: str
    coefficients: int
    score: Score


def climbed(subject: Subject, names: Iterable[str] | None = None) -> Iterator[Step]:
    """Try every rung of the ladder on one blade, or those named."""
    for name in names or RUNGS:
        n, rung = RUNGS[name]
        curves = rung(subject)
        yield Step(subject.name, subject.region, name, n, score(subject.sides, curves))


def _each(follow: Callable[[Stretch], Curves]) -> Rung:
    return lambda subject: (follow(subject.suction), follow(subject.pressure))


def _match(spacing: Spacing, model: Model, scheme: Scheme) -> Rung:
    return _each(partial(matched, spacing=spacing, model=model, scheme=scheme))


RUNGS: Final[dict[str, tuple[int, Rung]]] = {
    "uniform steps": (4, _match("uniform", "paper", "forward")),
    "arc length": (4, _match("arc-length", "paper", "forward")),
    "midpoint": (4, _match("arc-length", "paper", "midpoint")),
    "affine": (5, _match("arc-length", "affine", "midpoint")),
    "second order": (9, _match("arc-length", "second-order", "midpoint")),
    "on the trajectory": (5, _each(on_trajectory)),
    "quadratic": (11, _each(quadratic)),
    f"{SEGMENTS} segments": (5 * SEGMENTS, _each(partial(segmented, segments=SEGMENTS))),
    **{f"modal, n = {size(o)}": (size(o), partial(modal, order=o)) for o in ORDERS},
    **{f"B-spline, n = {size(o)}": (size(o), _each(partial(spline, n=size(o)))) for o in ORDERS},
}
