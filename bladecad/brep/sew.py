"""Faces become one closed solid, and keep their names."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

import cadquery as cq
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeSolid, BRepBuilderAPI_Sewing
from OCP.BRepLib import BRepLib

from bladecad.brep.names import FaceName
from bladecad.errors import GeometryError


def sew(faces: Mapping[FaceName, cq.Face], gap: float) -> tuple[cq.Solid, Mapping[str, cq.Face]]:
    """Sew the faces where their edges are closer than `gap` mm, and close them to a solid.

    Returns
    -------
    solid : cq.Solid
        Normals outward.
    faces : mapping of str to cq.Face
        The faces as they are in the solid, under their old names.

    Raises
    ------
    GeometryError
        If an edge stays free, or the faces do not make one shell.
    """
    sewing = BRepBuilderAPI_Sewing(gap)
    for face in faces.values():
        sewing.Add(face.wrapped)
    sewing.Perform()
    solid = _closed(sewing, gap)
    sewn = {name: cq.Face(sewing.Modified(face.wrapped)) for name, face in faces.items()}
    return solid, MappingProxyType({name: _inside(solid, face) for name, face in sewn.items()})


def _closed(sewing: BRepBuilderAPI_Sewing, gap: float) -> cq.Solid:
    free = sewing.NbFreeEdges()
    if free:
        raise GeometryError(
            f"{free} edges stay free after sewing at {gap:g} mm; the sides must share their "
            "pole columns and both ends their planes"
        )
    shell = cq.Shape.cast(sewing.SewedShape())
    if not isinstance(shell, cq.Shell):
        raise GeometryError(f"sewing gave a {shell.ShapeType().lower()}, one shell is due")
    solid = BRepBuilderAPI_MakeSolid(shell.wrapped).Solid()
    if not BRepLib.OrientClosedSolid_s(solid):
        raise GeometryError("the sewn shell is open: inside and outside cannot be told apart")
    return cq.Solid(solid)


def _inside(solid: cq.Solid, face: cq.Face) -> cq.Face:
    for candidate in solid.Faces():
        if candidate.isSame(face):
            return candidate
    raise GeometryError("a face was lost in sewing")
