"""Can this be a blade? What geometry alone refuses, with the place and what to do."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from bladecad.arrays import Array, Points, Vector
from bladecad.curves.develop import Flat, frame
from bladecad.data.loops import size
from bladecad.data.sections import MM_PER, Section, Sections
from bladecad.errors import DataError

LONG_GAP = 5.0  # times the spacing on both sides: published sections reach 2.0
WIDE_GAP = 0.05  # of the perimeter
NEAR_SECTIONS = 4  # whose median size a section is compared with
OTHER_SIZE = 2.4  # times that; inches for centimetres are 2.54
BLOCK = 256  # segments compared with all others at a time
TURNED = 0.4  # of the misfit that is left once a section is turned
MISFIT = 0.012  # of the size: camber may change its sign, so less is no sign of a turn
PROBES = 100
TURNS = {
    "turned by 180 degrees": np.array([-1.0, -1.0]),
    "mirrored in the tangential direction": np.array([1.0, -1.0]),
    "mirrored in the axial direction": np.array([-1.0, 1.0]),
}


def refuse_sizes(sections: Sections) -> None:
    """Raise where one section has another size than those beside it: a mix-up of units."""
    sizes = np.array([size(section.points) for section in sections.sections])
    m = len(sizes)
    if m < 3:
        return
    for k, section in enumerate(sections.sections):
        near = sorted((j for j in range(m) if j != k), key=lambda j: abs(j - k))[:NEAR_SECTIONS]
        usual = float(np.median(sizes[near]))
        ratio = float(sizes[k]) / usual
        if not 1 / OTHER_SIZE < ratio < OTHER_SIZE:
            raise DataError(
                f'section "{section.name}" is {sizes[k]:.4g} mm large, those beside it '
                f"{usual:.4g} mm, {ratio:.3g} times that{_units_apart(ratio)}; bring it to the "
                "unit of the others or leave it out"
            )


def refuse_crossings(section: Section, flat: Flat) -> None:
    """Raise where the outline crosses itself."""
    crossing = first_crossing(flat.points, section.closed)
    if crossing is None:
        return
    i, j = crossing
    n = len(section.points)
    raise DataError(
        f'section "{section.name}": the outline crosses itself between points {i + 1}-'
        f"{(i + 1) % n + 1} and {j + 1}-{(j + 1) % n + 1}, near {place(section.points[i])} mm; "
        "the points from one to the other may be out of order: sort or remove them"
    )


def refuse_gaps(section: Section) -> None:
    """Raise where points are missing: a step far longer than the steps on both sides of it."""
    steps = np.linalg.norm(np.roll(section.points, -1, axis=0) - section.points, axis=1)
    perimeter = float(steps.sum())
    beside = np.max([np.roll(steps, k) for k in (-2, -1, 1, 2)], axis=0)
    gap = (steps > LONG_GAP * beside) & (steps > WIDE_GAP * perimeter)
    if not section.closed:
        gap[-1] = False  # a cut-off edge, or a loop left open
    if gap.any():
        i = int(np.where(gap, steps, 0.0).argmax())
        j = (i + 1) % len(steps)
        raise DataError(
            f'section "{section.name}": a gap of {steps[i]:.3g} mm between points {i + 1} and '
            f"{j + 1}, near {place(section.points[i])} mm, {steps[i] / perimeter:.0%} of the "
            f"perimeter and {steps[i] / beside[i]:.2g} times the spacing beside it; measure the "
            "missing points or leave the section out"
        )


def refuse_turned(sections: Sections, flats: Sequence[Flat]) -> None:
    """Raise where a section only fits the one before it turned round or mirrored."""
    shapes = [_shape(flat) for flat in flats]
    changes = [0, *(_unlike(a, b) for a, b in pairwise(shapes))]
    way = np.cumsum(changes) % 2
    odd = np.flatnonzero(way != (2 * way.sum() > len(way)))
    if len(odd) == 0:
        return
    k = int(odd[0])
    how = _turn(shapes[k], shapes[k - 1 if k else 1])
    names = ", ".join(f'"{sections.sections[i].name}"' for i in odd)
    raise DataError(
        f"section {names}: {how} against the sections beside it; turn it back or leave it out"
    )


def first_crossing(loop: Points, closed: bool) -> tuple[int, int] | None:
    """Return two segments of a flat line that cross, (i, j) for points i to i+1 and j to j+1."""
    ends = np.roll(loop, -1, axis=0)
    a, b = (loop, ends) if closed else (loop[:-1], ends[:-1])
    for start in range(0, len(a), BLOCK):
        i, j = _boxes_meet(a, b, start)
        apart = (j > i + 1) & ~((i == 0) & (j == len(loop) - 1))
        i, j = i[apart], j[apart]
        cut = (_side(a[i], b[i], a[j]) != _side(a[i], b[i], b[j])) & (
            _side(a[j], b[j], a[i]) != _side(a[j], b[j], b[i])
        )
        if cut.any():
            return int(i[cut][0]), int(j[cut][0])
    return None


def place(point: Vector) -> str:
    """Return a point as "(x, y, z)"."""
    return "({})".format(", ".join(f"{x:.3f}" for x in point))


def _units_apart(ratio: float) -> str:
    pairs = {(a, b): MM_PER[a] / MM_PER[b] for a in MM_PER for b in MM_PER}
    a, b = min(pairs, key=lambda pair: abs(np.log(pairs[pair] / ratio)))
    return f" (as {a} are to {b})" if abs(np.log(pairs[a, b] / ratio)) < 0.2 else ""


def _boxes_meet(a: Points, b: Points, start: int) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Segments whose boxes meet: numbers i in the block, and j."""
    some = slice(start, start + BLOCK)
    (x0, y0), (x1, y1) = np.minimum(a, b).T, np.maximum(a, b).T
    meet = (x0[some, None] <= x1) & (x1[some, None] >= x0)
    meet &= (y0[some, None] <= y1) & (y1[some, None] >= y0)
    i, j = np.nonzero(meet)
    return i + start, j


def _side(a: Points, b: Points, p: Points) -> NDArray[np.bool_]:
    ab, ap = b - a, p - a
    return np.asarray(ab[:, 0] * ap[:, 1] - ab[:, 1] * ap[:, 0] > 0)


def _shape(flat: Flat) -> Array:
    """Evenly spaced points of a flat loop about their centre, as parts of its size."""
    loop = np.concatenate([flat.points, flat.points[:1]])
    s = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(loop, axis=0), axis=1))])
    even = np.linspace(0.0, s[-1], PROBES, endpoint=False)
    shape = np.column_stack([np.interp(even, s, loop[:, 0]), np.interp(even, s, loop[:, 1])])
    return np.asarray((shape - shape.mean(axis=0)) / size(shape))


def _unlike(shape: Array, other: Array) -> bool:
    """Whether a shape fits another much better once turned, with or without the twist."""
    for own in (shape, _untwisted(shape, other)):
        as_is = _misfit(own, other)
        turned = min(_misfit(own * turn, other) for turn in TURNS.values())
        if as_is > MISFIT and turned < TURNED * as_is:
            return True
    return False


def _turn(shape: Array, other: Array) -> str:
    return min(TURNS, key=lambda how: _misfit(shape * TURNS[how], other))


def _untwisted(shape: Array, other: Array) -> Array:
    """Turn a shape by the angle, 90 degrees at most, between its long direction and another's."""
    own, wanted = (frame(points)[1][0] for points in (shape, other))
    wanted = wanted if own @ wanted >= 0 else -wanted
    cos, sin = own @ wanted, own[0] * wanted[1] - own[1] * wanted[0]
    return np.asarray(shape @ np.array([[cos, sin], [-sin, cos]]))


def _misfit(shape: Array, other: Array) -> float:
    """Mean distance from one shape to the points of another."""
    squares = np.sum(shape**2, axis=1)[:, None] + np.sum(other**2, axis=1) - 2.0 * shape @ other.T
    return float(np.sqrt(np.maximum(squares.min(axis=1), 0.0)).mean())
