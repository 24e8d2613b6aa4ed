"""A blade built from a scan."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, final

import numpy as np

from bladecad.arrays import Array, Vector
from bladecad.curves.odd import OddSection
from bladecad.curves.outliers import Misprint
from bladecad.curves.sides import BladeLines
from bladecad.data.scan import Scan
from bladecad.data.sections import Sections
from bladecad.deviation.inspecting.measure import Deviation
from bladecad.fit.blade import BladeFit
from bladecad.fit.left_out import LeftOut
from bladecad.pipeline.body import Body
from bladecad.pipeline.scan_settings import ScanSettings
from bladecad.scans.finding.airfoil import Airfoil
from bladecad.scans.fitting.whole import WholeFit
from bladecad.scans.judging.scanned import Scanned
from bladecad.scans.judging.support import Gap
from bladecad.scans.judging.systematic import ERRORS
from bladecad.surface.blade import BladeSurface
from bladecad.surface.loft import Loft
from bladecad.surface.triangulate import BladeMesh

if TYPE_CHECKING:
    from bladecad.brep.solid import Solid


@final
@dataclass(frozen=True, eq=False)
class ScanBuild:
    """A blade from scan to solid, and everything known about it on the way.

    sections : the slices that the fit started from
    lines    : sections of the fitted surface, hub to tip
    scanned  : airfoil, fit to all points, gaps, transform
    body     : loft, solid, triangles
    deviation : of all points of the airfoil
    seconds  : wall time of each step

    All but `scan` and `airfoil` is in the frame of the files; `transform` leads to it.
    """

    settings: ScanSettings
    sections: Sections
    lines: BladeLines
    scanned: Scanned
    body: Body
    deviation: Deviation
    seconds: dict[str, float] = field(default_factory=dict)

    @property
    def misprints(self) -> tuple[Misprint, ...]:
        """None: outliers of a scan have no weight in its fit."""
        return ()

    @property
    def odd(self) -> tuple[OddSection, ...]:
        """None: all points were fitted at once."""
        return ()

    @property
    def left_out(self) -> LeftOut | None:
        """Nothing was: what the scan says of the surface is told by its points."""
        return None

    @property
    def scan(self) -> Scan:
        """What was measured, as it was measured."""
        return self.airfoil.scan

    @property
    def airfoil(self) -> Airfoil:
        """What of the scan is airfoil."""
        return self.scanned.airfoil

    @property
    def whole(self) -> WholeFit:
        """The fit to all points of the airfoil."""
        return self.scanned.whole

    @property
    def gaps(self) -> tuple[Gap, ...]:
        """Places of the surface without points."""
        return self.scanned.gaps

    @property
    def transform(self) -> Array:
        """From the frame of the scan to that of the files, (4, 4)."""
        return self.scanned.transform

    @property
    def fit(self) -> BladeFit:
        """Both sides as flows."""
        return self.whole.fit

    @property
    def surface(self) -> BladeSurface:
        """S(u,t)."""
        return self.whole.surface

    @property
    def loft(self) -> Loft:
        """The B-spline patches."""
        return self.body.loft

    @property
    def solid(self) -> Solid:
        """The solid and its witnesses."""
        return self.body.solid

    @property
    def mesh(self) -> BladeMesh:
        """The triangles."""
        return self.body.mesh

    @property
    def noise(self) -> float:
        """Of the scan, mm, one sigma."""
        return self.whole.noise

    @property
    def between(self) -> Vector:
        """Nothing is left out: points lie between the sections, too; (m,) NaN."""
        return np.full(len(self.surface.span), np.nan)

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why the blade is out of tolerance, one sentence each."""
        fit = (f"the fit is {self.fit.reason}",) if self.fit.reason else ()
        return (*fit, *_away(self.scanned, self.settings.tolerance))

    @property
    def within(self) -> bool:
        """Whether fit and systematic deviation are within the tolerance."""
        return not self.reasons


def _away(scanned: Scanned, tolerance: float) -> tuple[str, ...]:
    worst = scanned.systematic.worst
    if worst is None or worst.sure <= tolerance:
        return ()
    return (
        f"{worst.points} points on the {worst.side} side around u = {worst.u:.3f}, "
        f"t = {worst.t:.3f} stand {1e3 * worst.mean:+.3g} um from the blade in the mean, by "
        f"{1e3 * worst.sure:.3g} um for sure ({ERRORS:g} standard errors less), "
        f"{1e3 * tolerance:.3g} um are allowed",
    )
