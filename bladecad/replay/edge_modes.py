"""bladecad's own fit on a subject, and the cubic B-spline with as many coefficients beside it."""

from __future__ import annotations

import numpy as np

from bladecad.arrays import Vector
from bladecad.fit.blade import Order
from bladecad.fit.essence import essence
from bladecad.fit.joint import solve_joint
from bladecad.fit.search import find_rates
from bladecad.fit.sidefit import SideFit
from bladecad.fit.spectrum import Spectrum
from bladecad.replay.curves import Curves
from bladecad.replay.subject import Stretch, Subject
from bladecad.splines import basis, clamped

CUBIC = 3


def size(order: Order) -> int:
    """Coefficients a section and coordinate, n = 2 (m_LE + m_TE) + p + 1."""
    return 2 * (order.le + order.te) + order.degree + 1


def modal(subject: Subject, order: Order) -> tuple[Curves, Curves]:
    """Fit both sides and evaluate them where the others are."""
    suction, pressure = (
        Curves(fit(stretch.t), fit(stretch.judged.t))
        for fit, stretch in zip(modal_fit(subject, order), subject.sides, strict=True)
    )
    return suction, pressure


def modal_fit(subject: Subject, order: Order) -> tuple[SideFit, SideFit]:
    """Fit both sides: rates by variable projection, then all coefficients with the edges joined."""
    spectra = spectra_of(subject, order)
    samples = (subject.suction.fitted, subject.pressure.fitted)
    joint = solve_joint(spectra, samples, subject.le, subject.te)
    return SideFit(spectra[:1], joint.suction), SideFit(spectra[1:], joint.pressure)


def spectra_of(subject: Subject, order: Order) -> tuple[Spectrum, Spectrum]:
    """Rates that all sections of a side share."""
    sides = [essence(side.fitted) for side in subject.sides]
    suction, pressure = (find_rates(order.le, order.te, order.degree, *s[:2]) for s in sides)
    return suction, pressure


def spline(stretch: Stretch, n: int) -> Curves:
    """Cubic B-spline of n coefficients, knots at quantiles of the points, by least squares."""
    inner = n - CUBIC - 1
    places = np.linspace(0.0, len(stretch.t) - 1.0, inner + 2)
    knots = clamped(np.interp(places, np.arange(len(stretch.t)), stretch.t), CUBIC)

    def values(t: Vector) -> Vector:
        return basis(knots, CUBIC, t)

    C = np.linalg.pinv(values(stretch.fitted.t)) @ stretch.fitted.points
    return Curves(values(stretch.t) @ C, values(stretch.judged.t) @ C)
