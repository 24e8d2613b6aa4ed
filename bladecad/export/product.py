"""What a finished blade brings to its files: a `pipeline.Build`, or a `ScanBuild`."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Protocol

import numpy as np

from bladecad.arrays import Vector
from bladecad.curves.odd import OddSection
from bladecad.curves.outliers import Misprint
from bladecad.curves.sides import BladeLines
from bladecad.data.sections import Sections
from bladecad.deviation.inspecting.measure import Deviation
from bladecad.fit.blade import BladeFit
from bladecad.fit.left_out import LeftOut
from bladecad.surface.blade import BladeSurface
from bladecad.surface.loft import Loft
from bladecad.surface.triangulate import BladeMesh

if TYPE_CHECKING:
    from bladecad.brep.solid import Solid
    from bladecad.scans.judging.scanned import Scanned


class Asked(Protocol):
    """What was asked for: a dataclass of options, the tolerance among them, mm."""

    @property
    def tolerance(self) -> float:
        """Of the fit and of the verdict, mm."""

    @property
    def chord_error(self) -> float:
        """Of the triangles, mm."""


class Product(Protocol):
    """A blade from points to solid, with all that is known about it; names as in `Build`."""

    @property
    def settings(self) -> Asked:
        """What was asked for."""

    @property
    def sections(self) -> Sections:
        """What was measured, in order."""

    @property
    def misprints(self) -> tuple[Misprint, ...]:
        """Points that were set aside."""

    @property
    def odd(self) -> tuple[OddSection, ...]:
        """Sections that stand off the run of the others."""

    @property
    def lines(self) -> BladeLines:
        """The sections broken at their edges."""

    @property
    def fit(self) -> BladeFit:
        """Both sides as flows."""

    @property
    def surface(self) -> BladeSurface:
        """S(u,t)."""

    @property
    def loft(self) -> Loft:
        """The B-spline patches, and how far they are from S."""

    @property
    def solid(self) -> Solid:
        """The solid and its witnesses."""

    @property
    def mesh(self) -> BladeMesh:
        """The triangles."""

    @property
    def deviation(self) -> Deviation:
        """Of the measured points from S."""

    @property
    def between(self) -> Vector:
        """Of each section from the surface without it, (m,) mm, NaN at the ends."""

    @property
    def left_out(self) -> LeftOut | None:
        """Of every second point from the fit without it, where that was measured."""

    @property
    def noise(self) -> float:
        """Upper bound of the noise of the points, mm."""

    @property
    def seconds(self) -> Mapping[str, float]:
        """Wall time of each step."""

    @property
    def scanned(self) -> Scanned | None:
        """What is known besides of a blade that came from a scan."""

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why the blade is out of tolerance, one sentence each."""

    @property
    def within(self) -> bool:
        """Whether the blade is within the tolerance."""


def between_sections(product: Product) -> Vector:
    """What was measured by leaving each section out, for the sections alone, (m,) mm.

    A surface that was matched anew between the sections has more flows than there are sections.
    """
    at = np.searchsorted(product.surface.span, product.lines.span - 1e-12)
    return np.asarray(product.between[at])
