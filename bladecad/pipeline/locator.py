"""Blade coordinates for nominals that are no flows: sections through them, fitted.

The surface found names side, span and chordwise place, and lays the sections for the report; the
distance itself is measured to the faces or triangles of the file.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, final

import numpy as np
from scipy.interpolate import BSpline, splprep

from bladecad.arrays import Points, Vector
from bladecad.brep.names import PRESSURE_SIDE, SUCTION_SIDE
from bladecad.curves.repair import repaired
from bladecad.curves.sides import split_sides
from bladecad.data.loops import two_sides
from bladecad.data.sections import Axis, Section, Sections, Source
from bladecad.data.slices import Triangles, loops_at, span_field, welded
from bladecad.errors import DataError, FitError
from bladecad.fit.blade import BladeFit
from bladecad.pipeline.build import Settings, fit, surface_of
from bladecad.surface.blade import BladeSurface

if TYPE_CHECKING:
    from bladecad.brep.patches import FacePatch, StepFaces

STATIONS: Final = 17
RIM: Final = 2e-3  # of the span, kept from hub and tip where they are not exactly known
POINTS: Final = 240  # of a section cut from triangles
TIGHT, LOOSE = 0.01, 0.05  # mm; the locator is fitted to the first, and refused beyond the second
NOISE: Final = 0.4  # of the chord error: rms of points on the sides of triangles
STEP: Final = 1.25  # from one outline to the next; 1.006 on Rotor 37
TURN: Final = 0.6  # share of the points that are spread by turning, the others by length


@final
@dataclass(frozen=True, eq=False)
class Locator:
    """A surface fitted to sections through a file, and how closely.

    surface : BladeSurface
    about   : machine axis
    axis    : (3,) float, span axis from hub to tip, None where the file's own lines were followed
    largest : mm, largest distance of the fit from the sections
    notes   : what was guessed
    """

    surface: BladeSurface
    about: Axis
    axis: Vector | None
    largest: float
    notes: tuple[str, ...]


def locator_of_faces(
    step: StepFaces, path: Path, settings: Settings, axis: Vector | None = None
) -> Locator:
    """Lay blade coordinates on a STEP file: along its own lines where it names both sides."""
    sides = step.patch(SUCTION_SIDE), step.patch(PRESSURE_SIDE)
    if axis is None and sides[0] is not None and sides[1] is not None:
        return _along_lines(sides[0], sides[1], path, settings)
    return locator_of_mesh(
        *step.mesh, path, settings, axis=axis, chord_error=step.usual_chord_error
    )


def locator_of_mesh(
    vertices: Points,
    triangles: Triangles,
    path: Path,
    settings: Settings,
    *,
    axis: Vector | None = None,
    chord_error: float = 0.005,
) -> Locator:
    """Lay blade coordinates on a mesh: slices from hub to tip, smoothed and fitted.

    Raises
    ------
    DataError
        If the mesh is not cut into single loops, or no fit follows them.
    """
    vertices, triangles = welded(vertices, triangles)
    field = span_field(vertices, triangles, axis)
    rim = max(RIM, 2.0 * field.misfit)
    levels = np.linspace(rim, 1.0 - rim, STATIONS)
    sections = []
    for level, loops in zip(
        levels, loops_at(vertices, triangles, field(vertices), levels), strict=True
    ):
        if not loops:
            raise DataError(
                f"{path.name}: no closed loop at {level:.1%} of the span; is it one blade without "
                "root and platform, and whole? give --span-axis"
            )
        sections.append(Section(f"{level:.3f}", _smoothed(loops[0], NOISE * chord_error)))
    _refuse_steps(sections, levels, path)
    told = ", ".join(f"{a:+.3f}" for a in field.axis)
    said = () if axis is not None else (f"span axis found: {told}; --span-axis says otherwise",)
    return _fitted(sections, path, settings, field.axis, said)


def _refuse_steps(sections: list[Section], levels: Vector, path: Path) -> None:
    """Refuse what is more than an airfoil: its outline changes in a step."""
    closed = [np.vstack([section.points, section.points[:1]]) for section in sections]
    around = np.array([np.linalg.norm(np.diff(p, axis=0), axis=1).sum() for p in closed])
    step = np.abs(np.diff(np.log(around)))
    k = int(step.argmax())
    if step[k] > np.log(STEP):
        raise DataError(
            f"{path.name}: the outline changes from {around[k]:.4g} to {around[k + 1]:.4g} mm "
            f"between {levels[k]:.0%} and {levels[k + 1]:.0%} of the span; a root, a platform or a "
            "shroud? cut the nominal down to its airfoil, or give --span-axis"
        )


def _along_lines(
    suction: FacePatch, pressure: FacePatch, path: Path, settings: Settings
) -> Locator:
    """Sections along lines of constant u, between the knots too, so that no span is skipped."""
    knots = np.unique(np.concatenate([suction.knots_u, pressure.knots_u]))
    u = np.interp(np.linspace(0, len(knots) - 1, STATIONS), np.arange(len(knots)), knots)
    t = _between(np.unique(suction.knots_t))
    rows = zip(suction(u, t), pressure(u, t), strict=True)
    sections = [
        two_sides(f"{place:.3f}", first, second, suction="first")
        for place, (first, second) in zip(u, rows, strict=True)
    ]
    return _fitted(sections, path, settings, None, ())


def _between(knots: Vector) -> Vector:
    """Knots and the middles between them."""
    return np.sort(np.concatenate([knots, 0.5 * (knots[1:] + knots[:-1])]))


def _fitted(
    sections: list[Section],
    path: Path,
    settings: Settings,
    axis: Vector | None,
    said: tuple[str, ...],
) -> Locator:
    about = settings.axis or _machine_axis(sections, axis)
    source = Source(path, "slices", axis=about)
    lines = split_sides(
        repaired(Sections(tuple(sections), source)), le=settings.le, suction=settings.suction
    )
    found = _closest(lambda: fit(lines, Settings(tolerance=TIGHT)))
    if found.errors.largest > LOOSE:
        raise DataError(
            f"{path.name}: no blade surface follows its slices closer than "
            f"{found.errors.largest:.3g} mm, {LOOSE} mm is needed to tell places on it apart; give "
            "--span-axis, or a nominal without fillets, root and platform"
        )
    return Locator(surface_of(found), about, axis, found.errors.largest, (*said, *lines.notes))


def _closest(fitting: Callable[[], BladeFit]) -> BladeFit:
    """The fit, or the best one on the way."""
    try:
        return fitting()
    except FitError as error:
        if not isinstance(error.best, BladeFit):
            raise
        return error.best


def _machine_axis(sections: list[Section], span: Vector | None) -> Axis:
    """z, or x where the blade stands along z."""
    if span is None:
        centres = np.array([section.points.mean(axis=0) for section in sections])
        span = centres[-1] - centres[0]
    return "z" if abs(span[2]) < np.sqrt(0.5) * np.linalg.norm(span) else "x"


def _smoothed(loop: Points, noise: float) -> Points:
    """A loop through triangles as a smooth line, its points densest where it turns."""
    closed = np.vstack([loop, loop[:1]])
    steps = np.linalg.norm(np.diff(closed, axis=0), axis=1)
    s = np.concatenate([[0.0], np.cumsum(steps)])
    noisy = len(loop) * 3 * noise**2
    found: tuple[Any, Any] = splprep(closed.T, u=s / s[-1], s=noisy, per=1)
    knots, c, degree = found[0]
    spline = BSpline(knots, np.stack(c, axis=1), degree)
    u = np.linspace(0.0, 1.0, 4000)
    d = spline(u, 1)
    d /= np.linalg.norm(d, axis=1, keepdims=True)
    turned = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(d, axis=0), axis=1))])
    density = TURN * turned / turned[-1] + (1.0 - TURN) * u
    places = np.interp(np.linspace(0.0, 1.0, POINTS, endpoint=False), density, u)
    return np.asarray(spline(places))
