"""From the surface to the body: lofted, closed, triangulated; the same for sections and scans."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, final

from bladecad.pipeline.clock import Clock
from bladecad.surface.blade import BladeSurface
from bladecad.surface.loft import Loft, loft
from bladecad.surface.triangulate import BladeMesh, triangulate
from bladecad.surface.volume import volume

if TYPE_CHECKING:
    from bladecad.brep.solid import Solid

LOFT: Final = 1e-3  # mm, distance of the solid from S


@final
@dataclass(frozen=True, eq=False)
class Body:
    """A surface as B-spline patches, as a solid, and as triangles."""

    loft: Loft
    solid: Solid
    mesh: BladeMesh


def body_of(surface: BladeSurface, *, tolerance: float, chord_error: float, clock: Clock) -> Body:
    """Turn a surface into a solid that is believed, and into triangles.

    Parameters
    ----------
    surface : BladeSurface
    tolerance : float
        mm; sides may lie in each other as deep as they are exact.
    chord_error : float
        mm, of the triangles.
    clock : Clock
        Steps "loft", "solid" and "triangles".

    Raises
    ------
    GeometryError
        If the solid is not what it must be.
    """
    with clock.step("loft"):
        lofted = loft(surface, tolerance=LOFT)
        inside = volume(lofted.suction, lofted.pressure)
    with clock.step("solid"):
        from bladecad.brep.limits import Limits
        from bladecad.brep.solid import build_solid

        limits = Limits(fold=max(Limits.fold, tolerance))
        solid = build_solid(lofted.suction, lofted.pressure, volume=inside, limits=limits)
    with clock.step("triangles"):
        mesh = triangulate(surface, chord_error=chord_error, volume=inside)
    return Body(lofted, solid, mesh)
