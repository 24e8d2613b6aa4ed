"""The passage round a blade as a solid: a sector of the annulus, cut by its faces and the blade."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Final, TypeAlias, final

import cadquery as cq
import numpy as np
from OCP.BRep import BRep_Tool
from OCP.BRepAlgoAPI import BRepAlgoAPI_Common, BRepAlgoAPI_Cut, BRepAlgoAPI_Splitter
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakeWire,
    BRepBuilderAPI_Transform,
)
from OCP.BRepPrimAPI import BRepPrimAPI_MakeRevol
from OCP.gp import gp_Ax1, gp_Dir, gp_Pnt, gp_Trsf
from OCP.TopTools import TopTools_ListOfShape

from bladecad.brep.kernel import kernel
from bladecad.brep.passage_shape import Line, PassageShape
from bladecad.brep.solid import build_solid
from bladecad.brep.through import curve_of, kernel_point, surface_through
from bladecad.brep.witnesses import volume
from bladecad.errors import GeometryError
from bladecad.surface.volume import volume as quadrature

Named: TypeAlias = list[tuple[str, Any]]

VOLUME: Final = 1e-4  # relative, kernel against quadrature; walls printed coarsely are smoothed
EDGE: Final = 1e-2  # mm, the largest tolerance of an edge that two faces were cut to
SIDES: Final = {
    "SUCTION_SIDE": "BLADE_SUCTION",
    "PRESSURE_SIDE": "BLADE_PRESSURE",
    "LEADING_EDGE": "BLADE_LE",
    "TRAILING_EDGE": "BLADE_TE",
}


@final
@dataclass(frozen=True, eq=False)
class PassageSolid:
    """The fluid round one blade as a solid in mm.

    shape          : the cadquery solid
    faces          : INLET, OUTLET, HUB, SHROUD, PERIODIC_1, PERIODIC_2, BLADE_SUCTION,
                     BLADE_PRESSURE; BLADE_LE, BLADE_TE of blunt edges; BLADE_TIP, BLADE_HUB
                     before gaps
    volume         : mm^3, by the kernel
    volume_error   : relative, against the quadrature
    edge_tolerance : mm, the largest
    """

    shape: cq.Solid
    faces: Mapping[str, cq.Face]
    volume: float
    volume_error: float
    edge_tolerance: float


def passage_solid(shape: PassageShape) -> PassageSolid:
    """Cut the passage out of a sector of the annulus.

    Raises
    ------
    GeometryError
        If the kernel fails, or gives no single valid solid of the right volume, every face named.
    """
    sides = build_solid(
        shape.suction, shape.pressure, volume=quadrature(shape.suction, shape.pressure)
    )
    around = [(SIDES[name], face.wrapped) for name, face in sides.faces.items() if name in SIDES]
    with kernel("cutting the passage"):
        blade, around = _before_gaps(shape, sides.shape.wrapped, around)
        body, faces = _between_faces(shape)
        cut = BRepAlgoAPI_Cut(body, blade)
        return _believed(cq.Shape.cast(cut.Shape()), _followed(cut, faces + around), shape)


def _before_gaps(shape: PassageShape, blade: Any, around: Named) -> tuple[Any, Named]:
    """The blade up to its gaps, and the ends it gets there."""
    if shape.hub_end is None and shape.tip_end is None:
        return blade, around
    hub = shape.hub if shape.hub_end is None else shape.hub_end
    shroud = shape.shroud if shape.tip_end is None else shape.tip_end
    sector, (below, _, above, _) = _sector(shape, hub, shroud)
    common = BRepAlgoAPI_Common(blade, sector)
    ends = [("BLADE_HUB", below[1])] if shape.hub_end is not None else []
    ends += [("BLADE_TIP", above[1])] if shape.tip_end is not None else []
    return common.Shape(), _followed(common, around + ends)


def _between_faces(shape: PassageShape) -> tuple[Any, Named]:
    """The sector between both periodic faces, and its faces."""
    sector, walls = _sector(shape, shape.hub, shape.shroud)
    first = BRepBuilderAPI_MakeFace(surface_through(shape.periodic), 1e-7).Face()
    turn = gp_Trsf()
    turn.SetRotation(_axis(shape.axis), shape.pitch)
    second = BRepBuilderAPI_Transform(first, turn, True).Shape()
    split = BRepAlgoAPI_Splitter()
    split.SetArguments(_listed([sector]))
    split.SetTools(_listed([first, second]))
    split.Build()
    periodic = _followed(split, [("PERIODIC_1", first), ("PERIODIC_2", second)])
    parts = [
        part.wrapped
        for part in cq.Shape.cast(split.Shape()).Solids()
        if {name for name, face in periodic if _has(part, face)} == {"PERIODIC_1", "PERIODIC_2"}
    ]
    if len(parts) != 1:
        raise GeometryError(f"{len(parts)} bodies lie between the periodic faces, 1 is due")
    return parts[0], _followed(split, walls) + periodic


def _sector(shape: PassageShape, hub: Line, shroud: Line) -> tuple[Any, Named]:
    """Turn the outline of the channel round the axis; the faces that its four lines sweep."""
    lines = [
        BRepBuilderAPI_MakeEdge(curve_of(hub)).Edge(),
        BRepBuilderAPI_MakeEdge(kernel_point(hub.poles[-1]), kernel_point(shroud.poles[-1])).Edge(),
        BRepBuilderAPI_MakeEdge(curve_of(shroud)).Edge(),
        BRepBuilderAPI_MakeEdge(kernel_point(shroud.poles[0]), kernel_point(hub.poles[0])).Edge(),
    ]
    wire, edges = BRepBuilderAPI_MakeWire(), []
    for line in lines:
        wire.Add(line)
        edges.append(wire.Edge())  # the wire has its own, which share their ends
    outline = BRepBuilderAPI_MakeFace(wire.Wire(), True).Face()
    turned = BRepPrimAPI_MakeRevol(outline, _axis(shape.axis), shape.sweep)
    names = "HUB", "OUTLET", "SHROUD", "INLET"
    swept = [(n, turned.Generated(edge).First()) for n, edge in zip(names, edges, strict=True)]
    return turned.Shape(), swept


def _followed(builder: Any, named: Named) -> Named:
    """What became of faces in a boolean operation."""
    after = []
    for name, face in named:
        changed = list(builder.Modified(face))
        if changed:
            after += [(name, one) for one in changed]
        elif not builder.IsDeleted(face):
            after.append((name, face))
    return after


def _believed(cut: cq.Shape, named: Named, shape: PassageShape) -> PassageSolid:
    solids = cut.Solids()
    if len(solids) != 1 or not solids[0].isValid():
        said = "not valid" if len(solids) == 1 else f"{len(solids)} solids, not 1"
        raise GeometryError(f"the passage as a solid is {said}; look at the blade and the walls")
    faces: dict[str, cq.Face] = {}
    for face in solids[0].Faces():
        name = next((name for name, one in named if face.wrapped.IsSame(one)), None)
        if name is None:
            raise GeometryError(f"a {face.geomType()} face of the passage has no name")
        faces[name if name not in faces else f"{name}_{len(faces)}"] = face
    found = volume(solids[0])
    error = abs(found / shape.volume - 1.0)
    edge = max(BRep_Tool.Tolerance_s(one.wrapped) for one in solids[0].Edges())
    if error > VOLUME or edge > EDGE:
        raise GeometryError(
            f"the passage as a solid is {error:.2g} (relative) off the quadrature, {VOLUME:g} "
            f"allowed, its largest edge tolerance {edge:.2g} mm, {EDGE:g} mm allowed"
        )
    return PassageSolid(solids[0], faces, found, error, edge)


def _has(part: cq.Shape, face: Any) -> bool:
    return any(one.wrapped.IsSame(face) for one in part.Faces())


def _listed(shapes: Iterable[Any]) -> Any:
    found = TopTools_ListOfShape()
    for shape in shapes:
        found.Append(shape)
    return found


def _axis(column: int) -> gp_Ax1:
    return gp_Ax1(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(*np.eye(3)[column].tolist()))
