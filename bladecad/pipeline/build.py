"""The steps of the method, one line each: from a file of sections to a measured solid."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, final

from bladecad.arrays import Vector
from bladecad.curves.naming import Hand, Lead
from bladecad.curves.odd import OddSection, odd_sections
from bladecad.curves.outliers import Misprint, keep_masks, misprints, noise
from bladecad.curves.properties import properties
from bladecad.curves.repair import repaired
from bladecad.curves.sides import BladeLines, Edges, split_sides
from bladecad.data.read import read_sections
from bladecad.data.sections import Axis, Sections, Unit
from bladecad.deviation.inspecting.measure import Deviation, measure
from bladecad.errors import ToleranceError
from bladecad.fit.blade import BladeFit, ModelName, Order, SpectrumKind
from bladecad.fit.left_out import LeftOut, Masks, left_out
from bladecad.fit.matched import fit_matched
from bladecad.fit.modal import prepare
from bladecad.fit.order import fit_blade, met
from bladecad.fit.segments import fit_segments
from bladecad.one_thread import one_thread
from bladecad.pipeline.body import body_of
from bladecad.pipeline.clock import Clock, Progress
from bladecad.surface.between import leave_one_out
from bladecad.surface.blade import BladeSurface, EdgeKind, Law
from bladecad.surface.homotopy import refitted
from bladecad.surface.loft import Loft
from bladecad.surface.triangulate import BladeMesh

if TYPE_CHECKING:
    from bladecad.brep.solid import Solid

EDGES: dict[ModelName, tuple[EdgeKind, EdgeKind]] = {
    "paper": ("sharp", "blunt"),
    "affine": ("sharp", "blunt"),
    "second-order": ("sharp", "sharp"),
}


@final
@dataclass(frozen=True)
class Settings:
    """What a user can ask for.

    Settings()                      the modal fit to 0.01 mm
    Settings(tolerance=0.003)       a tighter one
    Settings(order=Order(3, 3, 11)) a fixed order, whatever it reaches
    Settings(model="paper")         the paper's eqs. (2)-(7), for comparison

    tolerance, chord_error : mm; of the fit and of the verdict, and of the triangles
    unit, axis             : of the file, where it does not say
    le, suction, edges     : see `split_sides`
    """

    tolerance: float = 0.01
    model: ModelName = "modal"
    order: Order | None = None
    spectrum: SpectrumKind = "shared"
    law: Law = "spline"
    unit: Unit | None = None
    axis: Axis | None = None
    le: Lead | None = None
    suction: Hand | None = None
    edges: Edges = "file"
    chord_error: float = 0.005

    def __post_init__(self) -> None:
        for name in ("tolerance", "chord_error"):
            value = getattr(self, name)
            if not 1e-6 <= value <= 10.0:
                raise ToleranceError(
                    f"{name.replace('_', ' ')} = {value} mm; it must lie between 1e-6 and 10 mm"
                )


@final
@dataclass(frozen=True, eq=False)
class Build:
    """A blade from points to solid, and everything known about it on the way.

    misprints: points set aside
    odd      : sections that stand off the trend of the others; they are built as they are
    between  : distance of each section from the surface blended without it, mm, NaN at the ends
    left_out : distance of every second point from the fit without it; None for matched models
    noise    : upper bound of the noise of the points, mm
    seconds  : wall time of each step
    """

    settings: Settings
    sections: Sections
    misprints: tuple[Misprint, ...]
    odd: tuple[OddSection, ...]
    lines: BladeLines
    fit: BladeFit
    surface: BladeSurface
    loft: Loft
    solid: Solid
    mesh: BladeMesh
    deviation: Deviation
    between: Vector
    left_out: LeftOut | None
    noise: float
    seconds: dict[str, float] = field(default_factory=dict)

    @property
    def scanned(self) -> None:
        """Nothing: the blade came from sections."""
        return

    @property
    def reasons(self) -> tuple[str, ...]:
        """Why the blade is out of tolerance, one sentence each."""
        asked, largest = self.settings.tolerance, self.deviation.largest
        name, point = self.deviation.worst()
        away = (
            f'point {point + 1} of section "{name}" stands {1e3 * largest:.3g} um from the blade, '
            f"{1e3 * asked:.3g} um are allowed"
        )
        fit = (f"the fit is {self.fit.reason}",) if self.fit.reason else ()
        return (*fit, *((away,) if largest > asked else ()))

    @property
    def within(self) -> bool:
        """Whether fit and measured points are within the tolerance."""
        return not self.reasons


def build(
    path: str | Path, settings: Settings = Settings(), *, progress: Progress = lambda _: None
) -> Build:
    """Turn a file of sections into a solid blade, and measure it, before anything is written.

    Parameters
    ----------
    path : path
        Any format that `read_sections` reads.
    settings : Settings
    progress : callable
        Told the name of each step as it begins.

    Raises
    ------
    DataError
        If the file cannot be read, or is no blade.
    FitError
        If no order meets the tolerance; its `best` is the closest fit.
    GeometryError
        If the solid is not what it must be.
    """
    clock = Clock(progress)
    with clock.step("read"):
        sections, found, keep = load(path, settings)
        lines = split(sections, settings, keep)
        odd = odd_sections(properties(lines, sections.axis))
    with clock.step("fit"):
        scatter = noise(sections)
        fitted = fit(lines, settings, scatter, progress)
    with clock.step("judge"):
        surface = surface_of(fitted, settings.law)
        between = leave_one_out(surface)
        alone = (
            left_out(sections, fitted, keep, lambda k: split(sections, settings, k))
            if fitted.order
            else None
        )
    body = body_of(
        surface, tolerance=settings.tolerance, chord_error=settings.chord_error, clock=clock
    )
    with clock.step("deviation"):
        deviation = measure(surface, body.mesh, sections, keep)
    return Build(
        settings, sections, found, odd, lines, fitted, surface, body.loft, body.solid, body.mesh,
        deviation, between, alone, scatter, clock.seconds,
    )  # fmt: skip


def load(path: str | Path, settings: Settings) -> tuple[Sections, tuple[Misprint, ...], Masks]:
    """Read sections, put them in order, and find the points to set aside."""
    sections = repaired(read_sections(path, unit=settings.unit, axis=settings.axis))
    found = misprints(sections)
    return sections, found, list(keep_masks(sections, found))


def split(sections: Sections, settings: Settings, keep: Masks) -> BladeLines:
    """Break the sections at their edges as the settings say."""
    return split_sides(
        sections, le=settings.le, suction=settings.suction, edges=settings.edges, keep=keep
    )


def fit(
    lines: BladeLines,
    settings: Settings,
    scatter: float = 0.0,
    progress: Progress = lambda _: None,
) -> BladeFit:
    """Fit the lines with the model of the settings; `scatter` is the noise of the points, mm."""
    with one_thread():
        if settings.model == "modal":
            return fit_blade(
                lines,
                tolerance=settings.tolerance,
                order=settings.order,
                spectrum=settings.spectrum,
                noise=scatter,
                progress=progress,
            )
        if settings.model == "segmented":
            return met(fit_segments(prepare(lines), settings.tolerance, progress))
        return fit_matched(lines, model=settings.model, tolerance=settings.tolerance)


def surface_of(fitted: BladeFit, law: Law = "spline") -> BladeSurface:
    """Blend the flows of a fit along the span.

    Flows matched line by line know nothing of each other: those of second order are held to the
    shared edge points and meet with a corner, the others leave a gap at the trailing edge. Under
    the linear law they are matched anew between the sections, as in the paper.
    """
    le, te = EDGES.get(fitted.model, (fitted.lines.le, fitted.lines.te))
    if law == "linear" and fitted.model in ("paper", "affine", "second-order"):
        return replace(refitted(fitted, fitted.model), le=le, te=te)
    return BladeSurface(fitted.lines.span, fitted.suction, fitted.pressure, law, le, te)
