"""The modal fit of a blade at a given order."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import final

import numpy as np

from bladecad.curves.sides import BladeLines
from bladecad.fit.blade import BladeFit, Order, SpectrumKind
from bladecad.fit.essence import Essence, essence
from bladecad.fit.joint import JointFit, solve_joint
from bladecad.fit.judge import SIDES, Bench, judge
from bladecad.fit.projection import project
from bladecad.fit.samples import Samples, densify
from bladecad.fit.search import find_rates
from bladecad.fit.sidefit import SideFit
from bladecad.fit.spectrum import Spectrum

PER_GAP = 4  # samples a gap that are fitted


@final
@dataclass(frozen=True, eq=False)
class Data:
    """What one blade is fitted to and judged on."""

    bench: Bench
    samples: tuple[Samples, Samples]

    @property
    def lines(self) -> BladeLines:
        """The lines themselves."""
        return self.bench.lines

    @cached_property
    def essences(self) -> tuple[Essence, Essence]:
        """What the search for rates takes, a side."""
        suction, pressure = (essence(s) for s in self.samples)
        return suction, pressure


def prepare(lines: BladeLines) -> Data:
    """Densify both sides, once for all orders."""
    suction, pressure = (densify(lines, side, PER_GAP) for side in SIDES)
    return Data(Bench.of(lines), (suction, pressure))


def fit_order(
    data: Data,
    order: Order,
    tolerance: float,
    *,
    spectrum: SpectrumKind = "shared",
    near: BladeFit | None = None,
) -> BladeFit:
    """Fit both sides with a given order: rates side by side, then all coefficients at once.

    Parameters
    ----------
    data : Data
    order : Order
        Without knots.
    tolerance : float
        mm, recorded and judged against; it does not change the fit.
    spectrum : {"shared", "varying"}
        "varying" lets log a and k vary linearly with u.
    near : BladeFit, optional
        A fit of a larger order to begin with what is left of its rates.
    """
    spectra = [_spectra(data, i, order, spectrum, near) for i in (0, 1)]
    return fit_spectra(data, order, spectra[0], spectra[1], tolerance)


def fit_spectra(
    data: Data,
    order: Order,
    suction: tuple[Spectrum, ...],
    pressure: tuple[Spectrum, ...],
    tolerance: float,
) -> BladeFit:
    """Find the coefficients for given spectra, one a side or one a section, and judge them."""
    lines = data.lines
    if len(suction) == 1:
        parts = [solve_joint((suction[0], pressure[0]), data.samples, lines.le, lines.te)]
    else:
        parts = [
            solve_joint(pair, _one_section(data.samples, i), lines.le, lines.te)
            for i, pair in enumerate(zip(suction, pressure, strict=True))
        ]
    on_suction = SideFit(suction, np.concatenate([part.suction for part in parts]))
    on_pressure = SideFit(pressure, np.concatenate([part.pressure for part in parts]))
    errors = judge(data.bench, on_suction, on_pressure)
    return BladeFit(
        "segmented" if order.knots else "modal",
        order,
        on_suction,
        on_pressure,
        lines,
        errors,
        tolerance,
        *_spread(parts),
        errors.refusal(tolerance),
    )


def _spectra(
    data: Data, side: int, order: Order, kind: SpectrumKind, near: BladeFit | None
) -> tuple[Spectrum, ...]:
    t, together, apart = data.essences[side]
    found = near and (near.suction, near.pressure)[side].bases[0]
    assert found is None or isinstance(found, Spectrum)
    shared = find_rates(order.le, order.te, order.degree, t, together, found)
    if kind == "shared":
        return (shared,)
    u = np.round(data.lines.span, 9)
    return project(shared, t, apart, np.column_stack([1.0 - u, u]))


def _one_section(samples: tuple[Samples, Samples], i: int) -> tuple[Samples, Samples]:
    suction, pressure = (Samples(s.t, s.points[i : i + 1]) for s in samples)
    return suction, pressure


def _spread(parts: list[JointFit]) -> tuple[int, int, float]:
    """Rank and free coefficients of the poorest solve, and the worst condition."""
    poorest = min(parts, key=lambda p: p.rank)
    return poorest.rank, poorest.free, max(p.condition for p in parts)
