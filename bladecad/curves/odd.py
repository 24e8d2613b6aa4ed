"""Sections that stand off the smooth run of the others along the span."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np

from bladecad.arrays import Vector
from bladecad.curves.properties import SectionProperties

FREEDOM = 2  # sections more than a curve has coefficients, at least
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

    A cubic over the span is fitted to the others; what it misses, in units of the standard error
    of that prediction, says how odd the section is. Worst first; odd sections judge no others.
    """
    span = np.array([one.span for one in found])
    odd: list[OddSection] = []
    for quantity, least in LEAST.items():
        values = np.array([float(getattr(one, quantity)) for one in found])
        least = least if quantity == "stagger" else least * float(np.median(values))
        keep = list(range(len(found)))
        while (one := _oddest(span[keep], values[keep], least)) is not None:
            k, expected = keep.pop(one[0]), one[1]
            odd.append(OddSection(found[k].name, k, quantity, float(values[k]), expected))
    return tuple(odd)


def _oddest(span: Vector, values: Vector, least: float) -> tuple[int, float] | None:
    """Return the section that stands out most and what it should be, None if none does."""
    degree = min(DEGREE, len(span) - 2 - FREEDOM)
    if degree < DEGREE - 1:
        return None
    expected, error = np.array([_without(span, values, k, degree) for k in range(len(span))]).T
    off = np.abs(values - expected)
    k = int((off / error).argmax())
    return (k, float(expected[k])) if off[k] > max(ODD * error[k], least) else None


def _without(span: Vector, values: Vector, k: int, degree: int) -> tuple[float, float]:
    """Prediction of value k from all others, and its standard error."""
    others = np.arange(len(span)) != k
    terms = np.polynomial.legendre.legvander(2.0 * span - 1.0, degree)
    known = terms[others]
    inverse = np.linalg.pinv(known)
    fitted = inverse @ values[others]
    scatter = np.sum((values[others] - known @ fitted) ** 2) / (len(known) - degree - 1)
    leverage = float(np.sum((terms[k] @ inverse) ** 2))
    error = np.sqrt(max(scatter, TINY) * (1.0 + leverage))
    return float(terms[k] @ fitted), float(error)
