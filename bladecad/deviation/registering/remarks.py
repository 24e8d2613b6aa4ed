"""What the reader of a registration should know, in sentences."""

from __future__ import annotations

import numpy as np

from bladecad.arrays import Vector
from bladecad.deviation.registering.align import GATE, Aligned, Frame
from bladecad.deviation.registering.pose import FREEDOMS, Freedom

ONE_SIDED = 0.05  # of the points at least lie on either side of a blade that is scanned whole
SHORT = 0.05  # of the span may be missing at either end
POOR = 1e-3  # of the chord, robust: bent or twisted by a hundredth, or another blade much alike
MUCH = 0.05  # of the points are many to leave out
NO_GROWTH = 5e-4
BETTER = 0.5  # times the residual
WEAK = 0.01  # of the chord: a slide that the form of a scan can hide


def remarks(found: Aligned, frame: Frame) -> tuple[str, ...]:
    """A poor fit, sides and ends that are missing, points left out, weakly held motions."""
    return (
        *_poor(found, frame),
        *_sides(found),
        *_ends(found),
        *_left_out(found, frame),
        *_weak(found, frame),
    )


def remark_on_size(found: Aligned, grown: Aligned, size: float) -> tuple[str, ...]:
    """Whether the scan lies far better in another size: it has shrunk, or its scale is off."""
    if grown.scale >= BETTER * found.scale or abs(size - 1.0) < NO_GROWTH:
        return ()
    return (
        f"the scan lies on the nominal to {grown.scale:.2g} mm (robust) when it is made "
        f"{size:.4f} times as large, to {found.scale:.2g} mm as it is: check scale and temperature",
    )


def motion(slack: Vector, frame: Frame) -> str:
    """The larger part of a motion in words, as a direction in the frame of the nominal."""
    shift, turn = slack[:3], slack[3:]
    if np.linalg.norm(shift) >= frame.reach * np.linalg.norm(turn):
        return f"a shift along {_direction(shift)}"
    return f"a rotation about {_direction(turn)}"


def to_lock(slack: Vector, frame: Frame) -> Freedom:
    """The free coordinate that stops the motion most."""
    size = np.abs(slack * np.repeat([1.0, frame.reach], 3)) * frame.free
    return FREEDOMS[int(np.argmax(size))]


def _direction(a: Vector) -> str:
    a = a / np.linalg.norm(a)
    return "(" + ", ".join(f"{x:.2f}" for x in a + 0.0) + ")"


def _poor(found: Aligned, frame: Frame) -> tuple[str, ...]:
    if found.scale <= POOR * frame.chord:
        return ()
    return (
        f"the scan stands {found.scale:.2g} mm (robust) from the nominal, {100 * POOR:g} % of the "
        f"chord is {POOR * frame.chord:.2g} mm: check that it is this blade and not its neighbour",
    )


def _sides(found: Aligned) -> tuple[str, ...]:
    share = found.met.suction
    if ONE_SIDED <= share <= 1.0 - ONE_SIDED:
        return ()
    name, other = ("suction", "pressure") if share > 0.5 else ("pressure", "suction")
    return (
        f"the scan is one-sided: {100 * max(share, 1 - share):.0f} % of its points lie on the "
        f"{name} side; the pose rests on it alone, and the {other} side is not measured",
    )


def _ends(found: Aligned) -> tuple[str, ...]:
    low, high = found.met.span
    if low <= SHORT and high >= 1.0 - SHORT:
        return ()
    return (f"the scan covers the span only from u = {low:.2f} to {high:.2f}",)


def _left_out(found: Aligned, frame: Frame) -> tuple[str, ...]:
    rim, far = found.met.rim, found.met.far
    total = rim + far + len(found.residual)
    if rim + far <= MUCH * total:
        return ()
    return (
        f"{100 * (rim + far) / total:.0f} % of the points did not count for the fit: "
        f"{100 * rim / total:.0f} % beyond the span, {100 * far / total:.0f} % further than "
        f"{GATE * frame.chord:.3g} mm from the blade",
    )


def _weak(found: Aligned, frame: Frame) -> tuple[str, ...]:
    slide = found.scale / max(float(found.stiffness[0]), 1e-12)
    if slide <= WEAK * frame.chord:
        return ()
    return (
        f"{motion(found.slack, frame)} is held only weakly: 1 mm of it changes the distances by "
        f"{1e3 * found.stiffness[0]:.0f} um (rms), and a form error like the scan's "
        f"{1e3 * found.scale:.0f} um can shift the pose by {slide:.1g} mm along it; lock "
        f"{to_lock(found.slack, frame)} if the machine knows it better",
    )
