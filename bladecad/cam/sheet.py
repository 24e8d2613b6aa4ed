"""What a CAM programmer asks of a blade before choosing cutters, gathered."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, final

import numpy as np

from bladecad.arrays import Points, Vector, seal
from bladecad.cam.cutter import Passes, largest_ball, passes
from bladecad.cam.edges import Edge, edges
from bladecad.cam.flank import Flank, flank
from bladecad.cam.places import Places, places
from bladecad.cam.stacking import stacking_axis
from bladecad.cam.stock import Stock, stock
from bladecad.cam.thickness import Thickness, thickness
from bladecad.data.sections import Machine
from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.errors import ToleranceError
from bladecad.surface.blade import BladeSurface
from bladecad.tolerance import EDGE_ZONE

MACHINE: Final = Machine()


@final
@dataclass(frozen=True)
class Cutting:
    """How a blade is to be cut; mm.

    ball      : radius of the ball cutter, and of the cylinder that flank milling would use
    scallop   : height of what may stand between two passes
    tolerance : how far flank milling may be from the blade
    """

    ball: float = 3.0
    scallop: float = 0.005
    tolerance: float = 0.05

    def __post_init__(self) -> None:
        for name in ("ball", "scallop", "tolerance"):
            value = getattr(self, name)
            if not 0.0 < value < np.inf:
                raise ToleranceError(f"{name} = {value:g} mm makes no sense; give more than 0")
        if self.scallop >= self.ball:
            raise ToleranceError(
                f"a scallop of {self.scallop:g} mm with a ball of radius {self.ball:g} mm; give a "
                "scallop below the radius"
            )


@final
@dataclass(frozen=True, eq=False)
class Spot:
    """A length and the place where it was found.

    value : mm; infinite where nothing bounds it
    place : in words
    """

    value: float
    place: str = ""


@final
@dataclass(frozen=True, eq=False)
class CamSheet:
    """A blade as a cutter meets it; lengths in mm.

    cutting    : what was asked about
    u          : (m,) float, span of the rows below
    le, te     : the edges, at every u
    flanks     : suction and pressure side against their best ruled surfaces
    concave    : least concave radius between the edge zones
    convex     : least convex radius anywhere
    ball       : radius of the largest ball that reaches everything but for the scallop
    chordwise, spanwise : passes along the chord, and along the span
    thickness  : between the edges
    stock      : what holds the blade
    """

    cutting: Cutting
    u: Vector
    le: Edge
    te: Edge
    flanks: tuple[Flank, Flank]
    concave: Spot
    convex: Spot
    ball: Spot
    chordwise: Passes
    spanwise: Passes
    thickness: Thickness
    stock: Stock

    def __post_init__(self) -> None:
        seal(self, u=(None,))

    @property
    def flank_error(self) -> float:
        """What a cylinder along rulings cannot reach on the worse side, mm."""
        return max(side.error(self.cutting.ball) for side in self.flanks)

    @property
    def flank_millable(self) -> bool:
        """Whether that is within the tolerance."""
        return self.flank_error <= self.cutting.tolerance


def cam_sheet(
    surface: BladeSurface, cutting: Cutting | None = None, *, machine: Machine = MACHINE
) -> CamSheet:
    """Measure what a blade asks of its cutters.

    Parameters
    ----------
    surface : BladeSurface
    cutting : Cutting, optional
    machine : Machine
        For the ring about its axis.
    """
    cutting = cutting or Cutting()
    skin, found = nominal_of(surface).sides, places(surface)
    ball = largest_ball(skin, found, cutting.scallop)
    chordwise, spanwise = passes(surface, found, radius=cutting.ball, scallop=cutting.scallop)
    le, te = edges(surface, found.u, machine.column)
    inner = (found.t >= EDGE_ZONE) & (found.t <= 1.0 - EDGE_ZONE)
    return CamSheet(
        cutting=cutting,
        u=found.u,
        le=le,
        te=te,
        flanks=(flank(surface, "suction"), flank(surface, "pressure")),
        concave=_radius(found, np.where(inner, -found.k2, 0.0)),
        convex=_radius(found, found.k1),
        ball=Spot(np.inf) if ball is None else Spot(ball[0], found.named(ball[1])),
        chordwise=chordwise,
        spanwise=spanwise,
        thickness=thickness(surface, skin, found.u),
        stock=stock(_with_caps(found), stacking_axis(surface), machine),
    )


def _radius(found: Places, k: Vector) -> Spot:
    """Least radius of some curvatures; below a thousandth of one over the size it is flat."""
    worst, size = int(k.argmax()), float(np.linalg.norm(np.ptp(found.points, axis=0)))
    largest = float(k.ravel()[worst])
    return Spot(1.0 / largest, found.named(worst)) if largest * size > 1e-3 else Spot(np.inf)


def _with_caps(found: Places) -> Points:
    """Places and, halfway between the rims, those of hub and tip: they may lie nearer the axis."""
    caps = found.X[:, [0, -1]].mean(axis=0).reshape(-1, 3)
    return np.concatenate([found.points, caps])
