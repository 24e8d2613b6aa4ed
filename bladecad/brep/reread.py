"""A CAD file read back, as another program would."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Final, Literal, TypeAlias, final

import cadquery as cq
import numpy as np
from OCP.BRep import BRep_Builder
from OCP.BRepTools import BRepTools
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.IGESCAFControl import IGESCAFControl_Reader
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TopoDS import TopoDS_Shape
from OCP.XCAFDoc import XCAFDoc_ShapeTool

from bladecad.arrays import Array, seal
from bladecad.brep.kernel import kernel
from bladecad.brep.labels import (
    empty_document,
    face_colour,
    face_layer,
    face_name,
    roots,
    text,
)
from bladecad.brep.statics import statics
from bladecad.brep.witnesses import volume
from bladecad.errors import ExportError

Format: TypeAlias = Literal["STEP", "IGES", "BREP"]
SETTINGS: Final[Mapping[str, str]] = {
    "xstep.cascade.unit": "MM",
    "read.stepcaf.subshapes.name": "On",
}
READERS: Final[Mapping[Format, Any]] = {
    "STEP": STEPCAFControl_Reader,
    "IGES": IGESCAFControl_Reader,
}


@final
@dataclass(frozen=True, eq=False)
class CadFile:
    """What stands in a CAD file, in mm.

    format  : "STEP", "IGES" or "BREP"
    shape   : the cadquery shape at the root, the compound of all where there are several
    product : the name of the first root
    solids  : how many solids there are
    faces   : all faces that have a name
    colours : sRGB of each named face that has one
    layers  : layer of each named face that lies on one
    valid   : the kernel's check
    volume  : mm^3
    bounds  : (2, 3) float, mm; smallest and largest corner
    """

    format: Format
    shape: cq.Shape
    product: str
    solids: int
    faces: Mapping[str, cq.Face]
    colours: Mapping[str, tuple[float, float, float]]
    valid: bool
    volume: float
    bounds: Array
    layers: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        seal(self, bounds=(2, 3))


def read_step(path: str | os.PathLike[str]) -> CadFile:
    """Read a STEP file with the names, colours and layers of its faces.

    Raises
    ------
    ExportError
        If the file cannot be read as STEP, or holds no shape.
    """
    return _read("STEP", os.fspath(path))


def read_iges(path: str | os.PathLike[str]) -> CadFile:
    """Read an IGES file with the names, colours and layers of its faces.

    Raises
    ------
    ExportError
        If the file cannot be read as IGES, or holds no shape.
    """
    return _read("IGES", os.fspath(path))


def read_brep(path: str | os.PathLike[str], *, names: Sequence[str] = ()) -> CadFile:
    """Read a BREP file; its faces, which have no names there, are given `names` in their order.

    Raises
    ------
    ExportError
        If the file cannot be read as BREP, or has another number of faces.
    """
    file, shape = os.fspath(path), TopoDS_Shape()
    with kernel(f"reading {file}"):
        if not BRepTools.Read_s(shape, file, BRep_Builder()) or shape.IsNull():
            raise ExportError(f"{file} cannot be read as BREP; is it there, and whole?")
        found = cq.Shape.cast(shape)
        faces = found.Faces()
        if names and len(names) != len(faces):
            raise ExportError(f"{file} has {len(faces)} faces, not {len(names)}")
        return _content("BREP", found, "", dict(zip(names, faces, strict=False)))


def named_faces(path: str | os.PathLike[str]) -> list[tuple[str, cq.Face]]:
    """Read all faces of a STEP file, each with its name, "" without one.

    Raises
    ------
    ExportError
        If the file cannot be read as STEP, or holds no face.
    """
    with statics(SETTINGS), kernel(f"reading {os.fspath(path)}"):
        document = _document("STEP", os.fspath(path))
        faces = [face for shape in _shapes(document) for face in shape.Faces()]
        if not faces:
            raise ExportError(f"{os.fspath(path)} holds no face")
        return [(face_name(document, face), face) for face in faces]


def bounds(shape: cq.Shape) -> Array:
    """Return the smallest and the largest corner of the box around a shape, (2, 3) mm."""
    box = shape.BoundingBox()
    return np.array([[box.xmin, box.ymin, box.zmin], [box.xmax, box.ymax, box.zmax]])


def _read(kind: Format, path: str) -> CadFile:
    with statics(SETTINGS), kernel(f"reading {path}"):
        document = _document(kind, path)
        shapes = _shapes(document)
        if not shapes:
            raise ExportError(f"{path} holds no shape")
        shape = shapes[0] if len(shapes) == 1 else cq.Compound.makeCompound(shapes)
        faces = {face_name(document, face): face for face in shape.Faces()}
        return _content(kind, shape, text(roots(document)[0]), faces, document)


def _document(kind: Format, path: str) -> Any:
    document, reader = empty_document(), READERS[kind]()
    reader.SetColorMode(True)
    reader.SetNameMode(True)
    reader.SetLayerMode(True)
    if reader.ReadFile(path) != IFSelect_ReturnStatus.IFSelect_RetDone:
        raise ExportError(f"{path} cannot be read as {kind}; is it there, and whole?")
    if not reader.Transfer(document):
        raise ExportError(f"{path} is {kind}, but nothing in it turns into a shape")
    return document


def _shapes(document: Any) -> list[cq.Shape]:
    return [cq.Shape.cast(XCAFDoc_ShapeTool.GetShape_s(root)) for root in roots(document)]


def _content(
    kind: Format,
    shape: cq.Shape,
    product: str,
    faces: Mapping[str, cq.Face],
    document: Any = None,
) -> CadFile:
    named = {name: face for name, face in faces.items() if name}
    look = named if document is not None else {}
    colours = {name: face_colour(document, face) for name, face in look.items()}
    layers = {name: face_layer(document, face) for name, face in look.items()}
    return CadFile(
        format=kind,
        shape=shape,
        product=product,
        solids=len(shape.Solids()),
        faces=MappingProxyType(named),
        colours=MappingProxyType({name: c for name, c in colours.items() if c is not None}),
        valid=shape.isValid(),
        volume=volume(shape),
        bounds=bounds(shape),
        layers=MappingProxyType({name: layer for name, layer in layers.items() if layer}),
    )
