"""Where in a scan the airfoil is: its axis, its heights, and its rough shape."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from bladecad.arrays import Mask, Points, Vector, seal
from bladecad.errors import DataError
from bladecad.scans.finding.axis import stacking_axis
from bladecad.scans.finding.height import Height, planes
from bladecad.scans.finding.refusals import no_blade
from bladecad.scans.finding.skeleton import Skeleton, skeleton
from bladecad.scans.finding.slabs import Slabs, slabs
from bladecad.scans.finding.span import beyond, cut, limits, run

WORTH: Final = 0.12  # of the points, times how well they are followed: less is no blade
ROOT: Final = 4  # slabs beyond the airfoil larger than it: a root or platform, no cap
SHORTEST: Final = 0.15  # span over chord
FOLLOWED: Final = 0.5  # of the slabs between given heights that must be sections
GIVEN: Final = 60  # slabs between given heights


@final
@dataclass(frozen=True, eq=False)
class Located:
    """Where in a scan the airfoil is.

    height, low, high, axis, notes : as those of `Airfoil`
    shape          : in the flat
    radius, middle : by which cylinders and cones are laid flat
    """

    height: Height
    axis: Vector
    low: float
    high: float
    shape: Skeleton
    radius: float
    middle: float
    notes: tuple[str, ...]

    def __post_init__(self) -> None:
        seal(self, axis=(3,))

    def flat(self, points: Points) -> Points:
        """Points laid flat, (k, 3), mm."""
        return self.height.flat(points, self.radius, self.middle)


def located(
    points: Points,
    *,
    axis: Vector | None = None,
    span: tuple[float, float] | None = None,
    height: Height | None = None,
) -> Located:
    """Find the airfoil among points of the skin of a scan; see `find_airfoil`.

    Raises
    ------
    DataError
        If they are no blade.
    """
    guessed = axis is None and height is None
    if height is None:
        height = planes(_found(points) if axis is None else np.asarray(axis))
    if span is not None:
        return _given(points, height, span, guessed)
    radius, middle = height.middle(points)
    flat = height.flat(points, radius, middle)
    found = cut(flat)
    taken = run(found)
    if taken is None:
        raise no_blade(points) if guessed else _none_across(height)
    notes = []
    if guessed:
        down, why = _upside_down(found, taken)
        notes.append(f"{why}; give --axis from hub to tip to choose")
        if down:
            turned = located(points, axis=-height.axis)
            return Located(
                turned.height, turned.axis, turned.low, turned.high, turned.shape, turned.radius,
                turned.middle, tuple(notes),
            )  # fmt: skip
    low, high, shape = limits(flat, found, taken)
    chord = float(np.median(found.chord[taken]))
    if high - low < SHORTEST * chord:
        raise no_blade(points) if guessed else _none_across(height)
    return Located(
        height, _up(height, points), low, high, shape, radius, middle, tuple(notes)
    )  # fmt: skip


def _none_across(height: Height) -> DataError:
    what = "planes across" if height.kind == "plane" else f"{height.kind}s about"
    return DataError(
        f"{what} the axis {_told(height.axis)} cut the scan into no run of slender closed loops "
        "that change slowly; leave --axis out, or give --span"
    )


def _found(points: Points) -> Vector:
    axis, worth = stacking_axis(points)
    if worth < WORTH:
        raise no_blade(points)
    return axis


def _given(points: Points, height: Height, span: tuple[float, float], guessed: bool) -> Located:
    """The airfoil between heights that the user gave."""
    low, high = min(span), max(span)
    if guessed and height.axis[np.abs(height.axis).argmax()] < 0.0:
        height = planes(-height.axis)
    radius, middle = height.middle(points)
    flat = height.flat(points, radius, middle)
    reach = float(flat[:, 2].min()), float(flat[:, 2].max())
    if not low < high or high <= reach[0] or low >= reach[1]:
        raise DataError(
            f"--span {span[0]:g}:{span[1]:g}: the scan lies between {reach[0]:.5g} and "
            f"{reach[1]:.5g} mm along the axis {_told(height.axis)}"
        )
    low, high = max(low, reach[0]), min(high, reach[1])
    found = slabs(flat, np.linspace(low, high, GIVEN + 1))
    good = found.quality > 0.0
    if good.mean() < FOLLOWED:
        raise DataError(
            f"between the heights {low:.5g} and {high:.5g} mm along the axis {_told(height.axis)} "
            f"{good.mean():.0%} of the slices are slender closed loops, {FOLLOWED:.0%} is needed; "
            "give another --span or --axis"
        )
    if guessed and _larger_above(found, good):
        return _given(points, planes(-height.axis), (-high, -low), False)
    shape = skeleton(flat, found, good)
    return Located(height, _up(height, points), low, high, shape, radius, middle, ())


def _upside_down(found: Slabs, taken: Mask) -> tuple[bool, str]:
    """Whether the hub is at the upper end: the root or platform, else the larger section."""
    below, above = beyond(found, taken)
    if max(below, above) >= ROOT:
        return above > below, "the end with the root or platform was taken as the hub"
    return _larger_above(found, taken), "the end with the larger section was taken as the hub"


def _larger_above(found: Slabs, taken: Mask) -> bool:
    area = found.area[taken]
    part = max(len(area) // 5, 1)
    return bool(np.median(area[-part:]) > np.median(area[:part]))


def _up(height: Height, points: Points) -> Vector:
    """Which way the height grows in the middle of points, (3,)."""
    if height.kind == "plane":
        return height.axis
    middle = points.mean(axis=0)
    step = 1e-4 * float(np.ptp(points, axis=0).max())
    grown = height(middle + step * np.eye(3)) - height(middle[None])
    return np.asarray(grown / np.linalg.norm(grown))


def _told(axis: Vector) -> str:
    return "({})".format(", ".join(f"{x:.4f}" for x in axis))
