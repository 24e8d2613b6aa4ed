"""Which edge leads and which side is suction: told by the file, the option, or the shape."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np

from bladecad.arrays import Points
from bladecad.curves.develop import cylindrical
from bladecad.curves.outline import Outline
from bladecad.data.sections import Sections

Lead = Literal["low", "high"]
Hand = Literal["left", "right"]
PROBES = np.linspace(0.0, 1.0, 65)
CLEAR_LEAD = 0.15  # score from which the shape alone tells the leading edge
CLEAR_CAMBER = 2e-3  # camber over chord from which the shape alone tells the suction side


def leading_edge(
    outlines: Sequence[Outline], sections: Sections, asked: Lead | None
) -> tuple[Lead, tuple[str, ...]]:
    """Tell whether the edge with the lower coordinate leads, with a note on how it was told.

    Parameters
    ----------
    outlines : sequence of Outline
        Edge 0 is the lower one on all of them.
    """
    if asked:
        return asked, ()
    by_file = [v for o in outlines if (v := _file_says(o)) is not None]
    if by_file:
        return ("low" if sum(by_file) * 2 >= len(by_file) else "high"), ()
    first, last = outlines[0].kinds
    if (first == "round") != (last == "round"):
        return ("low" if first == "round" else "high"), (
            "the round edge was taken as the leading edge; say --le low|high to choose",
        )
    if len(sections.row.hub) > 1:
        return _along_hub(outlines[0], sections), ()
    score = float(np.mean([_front_loading(o) for o in outlines]))
    if abs(score) < CLEAR_LEAD:
        return "low", (
            "the shape does not tell the leading edge; the edge with the lower coordinate along "
            "the machine axis was taken; say --le low|high to choose",
        )
    lead: Lead = "low" if score > 0 else "high"
    return lead, (f"the thicker end was taken as the leading edge (--le {lead}); --le to choose",)


def suction_side(outlines: Sequence[Outline], asked: Hand | None) -> tuple[bool, tuple[str, ...]]:
    """Tell whether suction is on the left, seen from the leading edge, with notes.

    Parameters
    ----------
    outlines : sequence of Outline
        Edge 0 is the leading edge on all of them.
    """
    camber = float(np.mean([_camber(o) for o in outlines]))
    votes = {o.section.name: v for o in outlines if (v := _file_side(o)) is not None}
    if asked:
        return asked == "left", ()
    if votes:
        left = sum(votes.values()) * 2 >= len(votes)
        odd = [name for name, vote in votes.items() if vote != left]
        notes = tuple(
            f'section "{name}": suction and pressure side were swapped against the other '
            "sections; put right"
            for name in odd
        )
        return left, notes
    hand = "left" if camber > 0 else "right"
    doubt = "" if abs(camber) > CLEAR_CAMBER else "the camber is small, so this is uncertain; "
    return camber > 0, (
        f"the convex side was taken as suction side; {doubt}say --suction left|right to choose "
        f"(taken: {hand}, seen from the leading edge)",
    )


def first_is_left(outline: Outline) -> bool:
    """Whether the first side lies to the left of the chord, seen from the leading edge."""
    x, y = outline.flat.points.T
    return bool(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) < 0)


def _file_says(outline: Outline) -> bool | None:
    """Whether the file calls edge 0 the leading one."""
    section = outline.section
    told = section.le or section.te
    if not told:
        return None
    ends = outline.sides[0](np.array([0.0, 1.0]))
    away = np.linalg.norm(ends - section.points[told[0]], axis=1)
    return bool((away[0] <= away[1]) == bool(section.le))


def _file_side(outline: Outline) -> bool | None:
    """Whether the file calls the left side suction."""
    section = outline.section
    if section.suction is None:
        return None
    leads = _file_says(outline)
    first = (section.suction == "first") == (leads is not False)
    return first == first_is_left(outline)


def _along_hub(outline: Outline, sections: Sections) -> Lead:
    """The edge that the flow along the hub line meets first."""
    ends = outline.sides[0](np.array([0.0, 1.0]))
    z, r, _ = cylindrical(ends, sections.axis)
    hub = sections.row.hub
    met = [int(np.hypot(*(hub - place).T).argmin()) for place in np.column_stack([z, r])]
    direction = 1 if hub[-1, 0] >= hub[0, 0] else -1
    return "low" if (met[0], direction * z[0]) <= (met[1], direction * z[1]) else "high"


def _front_loading(outline: Outline) -> float:
    """How much thicker the blade is towards edge 0: place of the thickness, ratio of the ends."""
    first, second = (side(PROBES) for side in outline.sides)
    d = np.linalg.norm(first - second, axis=1)
    centre = float((PROBES * d).sum() / d.sum())
    ends = float(np.log(np.interp(0.02, PROBES, d) / np.interp(0.98, PROBES, d)))
    return 4.0 * (0.5 - centre) + 0.3 * ends


def _camber(outline: Outline) -> float:
    """Mean offset of the camber line to the left of the chord, over the chord."""
    first, second = _laid_flat(outline)
    middle = 0.5 * (first + second)
    chord = middle[-1] - middle[0]
    left = np.array([-chord[1], chord[0]])
    return float(np.mean((middle - middle[0]) @ left) / (chord @ chord))


def _laid_flat(outline: Outline) -> tuple[Points, Points]:
    """The two sides at equal fractions in the flat of the section."""
    flat, points = outline.flat.points, outline.section.points
    sides = [side(PROBES) for side in outline.sides]
    near = [np.linalg.norm(points[None] - s[:, None], axis=2).argmin(axis=1) for s in sides]
    return flat[near[0]], flat[near[1]]
