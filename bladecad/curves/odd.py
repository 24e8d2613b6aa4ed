"""Sections that stand off the smooth run of the others along the span."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import final

import numpy as np

from bladecad.arrays import Vector
from bladecad.curves.properties import SectionProperties
from bladecad.curves.residuals import Mask

FREEDOM = {1: 2, 2: 4}  # sections more than coefficients, at least, to judge one or two together
DEGREE = 3  # of the curve over the span; 2 where the sections are too few
ODD = 6.0  # standard errors; published blades reach 5
TINY = 1e-24  # no scatter at all, as on designed blades
LEAST = {"stagger": np.radians(0.5), "chord": 0.01, "thickness": 0.05}  # chord, thickness: of it


@final
@dataclass(frozen=True)
class OddSection:
    """A section whose stagger, chord or thickness does not follow the other sections.

    quantity : "stagger" (radians), "chord" or "thickness" (mm)
    expected : what the cubic over the span through the other sections gives
    """

    section: str
    number: int
    quantity: str
    value: float
    expected: float

    def __str__(self) -> str:
        unit = "deg" if self.quantity == "stagger" else "mm"
        value, expected = (
            np.degrees(v) if self.quantity == "stagger" else v for v in (self.value, self.expected)
        )
        return (
            f'section "{self.section}": {self.quantity} {value:.2f} {unit}, the other sections '
            f"lead to {expected:.2f} {unit}; check it against its source"
        )


def odd_sections(found: Sequence[SectionProperties]) -> tuple[OddSection, ...]:
    """Name sections that stand clearly off the run of the others along the span.

    A cubic over the span (a parabola where sections are few) is fitted to the others; what it
    misses, in standard errors of that prediction, says how odd the section is. Two odd sections
    are looked for together where one alone does not stand out; odd sections judge no others.
    """
    span = np.array([one.span for one in found])
    odd: list[OddSection] = []
    for quantity, least in LEAST.items():
        values = np.array([float(getattr(one, quantity)) for one in found])
        least = least if quantity == "stagger" else least * float(np.median(values))
        keep = np.ones(len(found), dtype=bool)
        while group := _oddest(span, values, keep, least):
            keep[list(group)] = False
        expected, _ = _from_others(span, values, keep)
        odd += [
            OddSection(found[k].name, k, quantity, float(values[k]), float(expected[k]))
            for k in np.flatnonzero(~keep).tolist()
        ]
    return tuple(odd)


def _oddest(span: Vector, values: Vector, keep: Mask, least: float) -> tuple[int, ...]:
    """Return the section, or the two, that stand out most from the rest; () if none does."""
    for size, freedom in FREEDOM.items():
        best: tuple[int, ...] = ()
        most = ODD
        for group in combinations([int(k) for k in np.flatnonzero(keep)], size):
            others = keep & ~np.isin(np.arange(len(keep)), group)
            if others.sum() < DEGREE + freedom:
                continue
            expected, error = _from_others(span, values, others)
            off = np.abs(values - expected)[list(group)]
            ratio = float((off / error[list(group)]).min())
            if ratio > most and off.min() > least:
                best, most = group, ratio
        if best:
            return best
    return ()


def _from_others(span: Vector, values: Vector, others: Mask) -> tuple[Vector, Vector]:
    """Values of the curve through some sections at all of them, and their standard errors."""
    degree = DEGREE if others.sum() > DEGREE + FREEDOM[1] else DEGREE - 1
    terms = np.polynomial.legendre.legvander(2.0 * span - 1.0, degree)
    known = terms[others]
    inverse = np.linalg.pinv(known)
    fitted = inverse @ values[others]
    freedom = max(len(known) - degree - 1, 1)
    scatter = np.sum((values[others] - known @ fitted) ** 2) / freedom
    leverage = np.sum((terms @ inverse) ** 2, axis=1)
    return terms @ fitted, np.sqrt(max(scatter, TINY) * (1.0 + leverage))
