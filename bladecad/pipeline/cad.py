"""From a finished blade to one file for CAD or CAM: varied, offset, closed, written, measured."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Final, final

from bladecad.cam.variant import Variant, varied
from bladecad.errors import GeometryError, ToleranceError
from bladecad.pipeline.clock import Progress
from bladecad.surface.blade import BladeSurface, SideName
from bladecad.surface.loft import SIDES, Loft, loft
from bladecad.surface.volume import volume
from bladecad.surface.zones import Faces

if TYPE_CHECKING:
    from bladecad.brep.joints import Joint
    from bladecad.brep.reread import CadFile
    from bladecad.brep.solid import Solid
    from bladecad.export.cad.cad_file import Written
    from bladecad.export.cad.step import Schema

G1: Final = 0.1  # degrees; faces that meet at a round edge are held to it
SMOOTH: Final = 0.1  # of the tolerance, to make edges C2 and ends plane; the loft keeps to 0.8
FOLD: Final = 0.01  # mm; sides may lie in each other as deep as the usual fit is exact


@final
@dataclass(frozen=True)
class CadSettings:
    """What a solid for CAD can be asked for.

    CadSettings()                            the sides as two faces, within 1 um of S
    CadSettings(faces=4)                     with faces of their own round the edges
    CadSettings(variant=Variant(mirror="y")) the left-handed blade
    CadSettings(offset=0.3)                  with 0.3 mm left on it to be machined off

    faces     : 2, 4 or 1, see `surface.zones.divide`
    tolerance : mm, largest distance of the faces from the surface
    variant   : what is done to the surface first
    offset    : mm, outward, 0 for none
    """

    faces: Faces = 2
    tolerance: float = 1e-3
    variant: Variant = field(default_factory=Variant)
    offset: float = 0.0

    def __post_init__(self) -> None:
        if self.faces not in (1, 2, 4):
            raise ToleranceError(f"{self.faces} faces cannot be had; ask for 2, 4 or 1")
        if not 1e-6 <= self.tolerance <= 1.0:
            raise ToleranceError(
                f"tolerance = {self.tolerance} mm; it must lie between 1e-6 and 1 mm"
            )
        if not math.isfinite(self.offset):
            raise ToleranceError(f"an offset of {self.offset} mm is none; give mm, or 0")


@final
@dataclass(frozen=True, eq=False)
class CadBlade:
    """A blade as it is to be written.

    surface : as it was made by the variant, without the offset
    loft    : both sides as patches, with the offset
    solid   : believed, its round edges smooth
    """

    settings: CadSettings
    surface: BladeSurface
    loft: Loft
    solid: Solid


@final
@dataclass(frozen=True, eq=False)
class CadExport:
    """A file that was written, and what was measured on it once it had been read back.

    error  : mm; no point of its sides is further from the surface, or from its offset
    joints : how smoothly its faces meet
    """

    written: Written
    error: float
    joints: tuple[Joint, ...]


def cad_blade(
    surface: BladeSurface,
    settings: CadSettings = CadSettings(),
    *,
    progress: Progress = lambda _: None,
) -> CadBlade:
    """Turn a surface into the solid that is asked for.

    Raises
    ------
    GeometryError
        If the offset crosses itself, the solid is not believed, or a round edge is not smooth.
    """
    from bladecad.brep.joints import joints
    from bladecad.brep.limits import Limits
    from bladecad.brep.solid import build_solid

    made = varied(surface, settings.variant)
    lofted = _lofted(made, settings, progress)
    progress("solid")
    solid = build_solid(
        lofted.suction,
        lofted.pressure,
        volume=volume(lofted.suction, lofted.pressure),
        limits=Limits(
            fold=FOLD * max(settings.variant.scale, 1.0),
            smooth=SMOOTH * settings.tolerance,
            planar=min(Limits.planar, SMOOTH * settings.tolerance),
        ),
        faces=settings.faces,
    )
    _check_smooth(joints(solid, solid.zones), made)
    return CadBlade(settings, made, lofted, solid)


def export_cad(
    blade: CadBlade,
    path: str | os.PathLike[str],
    *,
    name: str,
    schema: Schema = "AP242DIS",
    progress: Progress = lambda _: None,
) -> CadExport:
    """Write a blade in the format of the suffix, read it back, and measure what was read.

    Raises
    ------
    ExportError
        As `write_cad`.
    """
    from bladecad.brep.joints import joints
    from bladecad.export.cad.cad_file import write_cad

    found: list[tuple[float, tuple[Joint, ...]]] = []

    def measure(file: CadFile) -> None:
        found.append((_error(blade, file), joints(file, blade.solid.zones)))

    progress("file")
    written = write_cad(blade.solid, path, name=name, schema=schema, measure=measure)
    return CadExport(written, *found[0])


def _lofted(surface: BladeSurface, settings: CadSettings, progress: Progress) -> Loft:
    if settings.offset:
        from bladecad.cam.offset import offset_loft

        progress("offset")
        return offset_loft(surface, settings.offset, tolerance=0.5 * settings.tolerance)
    progress("loft")
    return loft(surface, tolerance=settings.tolerance)


def _check_smooth(found: tuple[Joint, ...], surface: BladeSurface) -> None:
    """Refuse an edge that should be round and has a corner."""
    for joint in found:
        leads = joint.edge == "leading" or (joint.edge == "seam" and surface.le != "round")
        kind = surface.le if leads else surface.te
        if kind == "round" and joint.angle > G1:
            raise GeometryError(
                f"{' and '.join(joint.faces)} meet at {joint.angle:.3g} degrees along the "
                f"{joint.edge} edge, {G1:g} are allowed; fit with a smaller --tolerance"
            )


def _error(blade: CadBlade, file: CadFile) -> float:
    """Measured against the surface; of an offset against its loft, whose own error is added."""
    from bladecad.brep.astray import Side, astray

    if blade.settings.offset:
        sides: dict[SideName, Side] = {
            "suction": blade.loft.suction,
            "pressure": blade.loft.pressure,
        }
        return blade.loft.error + astray(file, blade.solid.zones, sides)
    exact = {name: partial(blade.surface, name) for name in SIDES}
    return astray(file, blade.solid.zones, exact)
