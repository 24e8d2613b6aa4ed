"""The nominal from any file: a model, sections, a STEP, a mesh."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Literal, TypeAlias, cast, final

import numpy as np

from bladecad.arrays import Points, Vector
from bladecad.brep.names import HUB, TIP
from bladecad.data.loops import size
from bladecad.data.scan_clean import cleaned
from bladecad.data.scan_mesh import mesh_format, read_mesh
from bladecad.data.sections import MM_PER, Axis, Unit
from bladecad.data.slices import FACING, Triangles
from bladecad.deviation.nearest.feet import Feet
from bladecad.deviation.nearest.nominal import (
    Nominal,
    nominal_of,
    nominal_of_mesh,
    nominal_of_patches,
)
from bladecad.deviation.nearest.referee import Referee, confirm, confirm_on
from bladecad.errors import DataError, FitError
from bladecad.fit.blade import BladeFit
from bladecad.pipeline.build import Settings, fit, load, split, surface_of
from bladecad.pipeline.clock import Progress
from bladecad.pipeline.locator import Locator, locator_of_faces, locator_of_mesh
from bladecad.surface.blade import BladeSurface
from bladecad.surface.triangulate import triangulate

Kind = Literal["model", "sections", "STEP", "mesh"]
SpanAxis: TypeAlias = tuple[float, float, float]
Confirm: TypeAlias = Callable[[Points, Feet], Referee]

CHORD_ERROR: Final = 0.005  # mm, of the triangles that the referee measures
LARGEST: Final = 0.05  # mm; sections that no flow follows closer than this are no nominal
BLADES: Final = (1.0, 5000.0)  # mm, size of blades


@final
@dataclass(frozen=True)
class NominalSettings:
    """How a nominal is read.

    tolerance : mm, of the fit where the nominal is a file of sections
    unit      : of the file, where it does not say or says wrongly
    axis, le, suction : as for a build
    span_axis : from hub to tip, of a STEP or a mesh; found where not given
    """

    tolerance: float = 0.01
    unit: Unit | None = None
    axis: Axis | None = None
    le: Literal["low", "high"] | None = None
    suction: Literal["left", "right"] | None = None
    span_axis: SpanAxis | None = None

    @property
    def build(self) -> Settings:
        """The same for a build."""
        return Settings(
            tolerance=self.tolerance, unit=self.unit, axis=self.axis, le=self.le,
            suction=self.suction,
        )  # fmt: skip


@final
@dataclass(frozen=True, eq=False)
class LoadedNominal:
    """A nominal and where it came from.

    nominal : Nominal
    kind    : of the file
    path    : of the file, None for a surface at hand
    unit    : of the file
    error   : mm, distance of the nominal from what the file says; 0 where it is the file itself
    stations : name of each section that it is made of, to its span
    axis    : column of the machine axis
    confirm : lets trimesh measure a sample of points against triangles of the nominal
    notes   : what was guessed, and by which road the distance is measured
    """

    nominal: Nominal
    kind: Kind
    path: Path | None
    unit: Unit
    error: float
    stations: Mapping[str, float]
    axis: int
    confirm: Confirm
    notes: tuple[str, ...]


def load_nominal(
    path: str | Path,
    settings: NominalSettings = NominalSettings(),
    *,
    progress: Progress = lambda _: None,
) -> LoadedNominal:
    """Read what a scan is measured against; the content decides what it is, not the suffix.

    Raises
    ------
    DataError
        If the file is none of model, sections, STEP and mesh, or no blade.
    FitError
        If no flow follows the sections.
    """
    path = Path(path)
    if path.is_dir():
        return _of_sections(path, settings, progress)
    start = _start(path)
    if start.lstrip().startswith(b"ISO-10303-21"):
        return _of_step(path, settings)
    if start.lstrip().startswith(b"{"):
        return _of_model(path, settings)
    if mesh_format(path):
        return _of_mesh(path, settings)
    return _of_sections(path, settings, progress)


def nominal_of_surface(
    surface: BladeSurface, path: Path | None = None, axis: int = 2
) -> LoadedNominal:
    """Take a surface that is at hand as the nominal."""
    return LoadedNominal(
        nominal_of(surface), "model", path, "mm", 0.0, _stations(surface), axis,
        _confirm(surface), (),
    )  # fmt: skip


def _start(path: Path) -> bytes:
    try:
        with path.open("rb") as file:
            start = file.read(256)
    except OSError as error:
        raise DataError(f"{path} cannot be read: {error.strerror}; check the path") from error
    if not start.strip():
        raise DataError(f"{path.name} is empty; export the nominal again")
    return start


def _of_model(path: Path, settings: NominalSettings) -> LoadedNominal:
    from bladecad.export.model.model_file import load as read_model

    if settings.unit not in (None, "mm"):
        raise DataError(f"{path.name}: a model file is in mm, not in {settings.unit}")
    return nominal_of_surface(read_model(path), path, "xyz".index(settings.axis or "z"))


def _of_sections(path: Path, settings: NominalSettings, progress: Progress) -> LoadedNominal:
    """Fit the sections as a build does; the closest fit serves where none is close enough."""
    sections, found, keep = load(path, settings.build)
    lines = split(sections, settings.build, keep)
    try:
        fitted = fit(lines, settings.build, progress=progress)
    except FitError as error:
        if not isinstance(error.best, BladeFit) or error.best.errors.largest > LARGEST:
            raise
        fitted = error.best
    surface, away = surface_of(fitted), fitted.errors.largest
    said = f"the nominal is fitted to its sections within {1e3 * away:.3g} um"
    if away > settings.tolerance:
        said += f", {1e3 * settings.tolerance:.3g} um were asked for"
    notes = (*sections.source.notes, *lines.notes, said)
    notes += (f"{len(found)} points of the nominal set aside",) if found else ()
    stations = dict(zip(lines.names, lines.span.tolist(), strict=True))
    return LoadedNominal(
        nominal_of(surface), "sections", path, sections.source.unit, away, stations, sections.axis,
        _confirm(surface), notes,
    )  # fmt: skip


def _of_mesh(path: Path, settings: NominalSettings) -> LoadedNominal:
    form = mesh_format(path)
    assert form is not None
    vertices, triangles, notes = cleaned(*read_mesh(path, form), soup=form == "STL")
    if triangles is None:
        raise DataError(f"{path.name} holds points and no triangles; a nominal needs a surface")
    scale = MM_PER[settings.unit or "mm"]
    vertices = vertices * scale
    _plausible(path, vertices, settings.unit)
    guess = () if settings.unit else (f"{path.name} does not say its unit: mm is taken",)
    triangles = _outwards(vertices, triangles)
    locator = locator_of_mesh(
        vertices, triangles, path, settings.build, axis=_axis(settings), chord_error=CHORD_ERROR
    )
    skin = _skin(vertices, triangles, locator)
    said = f"measured to the {len(triangles)} triangles of the nominal themselves"
    return LoadedNominal(
        nominal_of_mesh(vertices, triangles, locator.surface),
        "mesh", path, settings.unit or "mm", 0.0, _stations(locator.surface),
        "xyz".index(locator.about),
        lambda points, feet: confirm_on(vertices, skin, 0.0, points, feet),
        (*guess, *notes, *locator.notes, said, _told(locator)),
    )  # fmt: skip


def _of_step(path: Path, settings: NominalSettings) -> LoadedNominal:
    from bladecad.brep.patches import joined, read_faces

    scale = MM_PER[settings.unit] if settings.unit else 1.0
    step = read_faces(path, scale=scale, chord_error=CHORD_ERROR)
    _plausible(path, step.mesh[0], settings.unit)
    locator = locator_of_faces(step, path, settings.build, _axis(settings))
    skin = [f for f in step.faces if not _closes(f.name, f.vertices, f.triangles, locator.axis)]
    trimmed = [face.name for face in skin if face.patch is None]
    vertices, triangles = joined(skin)
    chord_error = max(face.chord_error for face in skin)
    if trimmed:
        nominal = nominal_of_mesh(vertices, _outwards(vertices, triangles), locator.surface)
        said = (
            f"{', '.join(trimmed)}: trimmed, so the nominal is measured to triangles that keep "
            f"{1e3 * chord_error:.3g} um to it"
        )
    else:
        patches = [(face.name, face.patch) for face in skin if face.patch is not None]
        nominal = nominal_of_patches(patches, locator.surface)
        said = f"measured to the faces of the file themselves: {', '.join(n for n, _ in patches)}"
    return LoadedNominal(
        nominal, "STEP", path, settings.unit or "mm", chord_error if trimmed else 0.0,
        _stations(locator.surface), "xyz".index(locator.about),
        lambda points, feet: confirm_on(
            vertices, triangles, 0.0 if trimmed else chord_error, points, feet,
            rim_error=chord_error,
        ),
        (*locator.notes, said, _told(locator)),
    )  # fmt: skip


def _stations(surface: BladeSurface) -> dict[str, float]:
    return {f"u = {u:.4g}": u for u in surface.span.tolist()}


def _axis(settings: NominalSettings) -> Vector | None:
    return None if settings.span_axis is None else np.array(settings.span_axis)


def _confirm(surface: BladeSurface) -> Confirm:
    return lambda points, feet: confirm(triangulate(surface, chord_error=CHORD_ERROR), points, feet)


def _closes(name: str, vertices: Points, triangles: Triangles, axis: Vector | None) -> bool:
    """Whether a face closes the blade at hub or tip."""
    if name in (HUB, TIP):
        return True
    if axis is None:
        return False
    n = _doubled(vertices, triangles)
    return bool(np.abs(n @ axis).sum() > FACING * np.linalg.norm(n, axis=1).sum())


def _skin(vertices: Points, triangles: Triangles, locator: Locator) -> Triangles:
    """The triangles of a mesh that face sideways."""
    assert locator.axis is not None
    n = _doubled(vertices, triangles)
    aside = np.abs(n @ locator.axis) <= FACING * np.linalg.norm(n, axis=1)
    return np.asarray(triangles[aside])


def _doubled(vertices: Points, triangles: Triangles) -> Points:
    """Normals of triangles, twice their area long."""
    a, b, c = np.moveaxis(vertices[triangles], 1, 0)
    return np.asarray(np.cross(b - a, c - a))


def _outwards(vertices: Points, triangles: Triangles) -> Triangles:
    """The triangles, turned where they are inside out as a whole."""
    corners = vertices[triangles] - vertices.mean(axis=0)
    inside = np.einsum("kx,kx->", corners[:, 0], np.cross(corners[:, 1], corners[:, 2]))
    return np.asarray(triangles if inside > 0 else triangles[:, ::-1])


def _told(locator: Locator) -> str:
    return (
        f"side, u and t are told by a surface within {1e3 * locator.largest:.3g} um of "
        "sections through the nominal"
    )


def _plausible(path: Path, vertices: Points, unit: Unit | None) -> None:
    """Refuse what has not the size of a blade, and name the unit that would give it."""
    extent = size(vertices)
    if BLADES[0] <= extent <= BLADES[1]:
        return
    raw = extent / MM_PER[unit or "mm"]
    likely = min(MM_PER, key=lambda one: abs(np.log(raw * MM_PER[one] / 100.0)))
    raise DataError(
        f"{path.name}: the nominal is {extent:.4g} mm large, blades are {BLADES[0]:g} to "
        f"{BLADES[1]:g} mm; wrong units? try --nominal-units {cast(str, likely)}"
    )
