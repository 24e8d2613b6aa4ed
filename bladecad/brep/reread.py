"""A STEP file read back, as another program would."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Final, final

import cadquery as cq
import numpy as np
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.Quantity import Quantity_Color, Quantity_TypeOfColor
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label, TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.XCAFDoc import (
    XCAFDoc_ColorTool,
    XCAFDoc_ColorType,
    XCAFDoc_DocumentTool,
    XCAFDoc_ShapeTool,
)

from bladecad.arrays import Array, seal
from bladecad.brep.kernel import kernel
from bladecad.brep.statics import statics
from bladecad.brep.witnesses import volume
from bladecad.errors import ExportError

SETTINGS: Final[Mapping[str, str]] = {
    "xstep.cascade.unit": "MM",
    "read.stepcaf.subshapes.name": "On",
}


@final
@dataclass(frozen=True, eq=False)
class StepFile:
    """What stands in a STEP file, in mm.

    shape   : the cadquery shape at the root, the compound of all where there are several
    product : the name of the first root
    solids  : how many solids there are
    faces   : all faces that have a name
    colours : sRGB of each named face that has one
    valid   : the kernel's check
    volume  : mm^3
    bounds  : (2, 3) float, mm; smallest and largest corner
    """

    shape: cq.Shape
    product: str
    solids: int
    faces: Mapping[str, cq.Face]
    colours: Mapping[str, tuple[float, float, float]]
    valid: bool
    volume: float
    bounds: Array

    def __post_init__(self) -> None:
        seal(self, bounds=(2, 3))


def read_step(path: str | os.PathLike[str]) -> StepFile:
    """Read a STEP file with its names and colours.

    Raises
    ------
    ExportError
        If the file cannot be read as STEP, or holds no shape.
    """
    with statics(SETTINGS), kernel(f"reading {os.fspath(path)}"):
        document = _document(os.fspath(path))
        roots = _roots(document)
        if not roots:
            raise ExportError(f"{os.fspath(path)} holds no shape")
        shapes = [cq.Shape.cast(XCAFDoc_ShapeTool.GetShape_s(root)) for root in roots]
        return _content(document, _text(roots[0]), shapes)


def named_faces(path: str | os.PathLike[str]) -> list[tuple[str, cq.Face]]:
    """Read all faces of a STEP file, each with its name, "" without one.

    Raises
    ------
    ExportError
        If the file cannot be read as STEP, or holds no face.
    """
    with statics(SETTINGS), kernel(f"reading {os.fspath(path)}"):
        document = _document(os.fspath(path))
        tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
        shapes = [cq.Shape.cast(XCAFDoc_ShapeTool.GetShape_s(root)) for root in _roots(document)]
        faces = [face for shape in shapes for face in shape.Faces()]
        if not faces:
            raise ExportError(f"{os.fspath(path)} holds no face")
        return [(_face_name(tool, face), face) for face in faces]


def _face_name(tool: Any, face: cq.Face) -> str:
    label = TDF_Label()
    return _text(label) if tool.Search(face.wrapped, label) else ""


def bounds(shape: cq.Shape) -> Array:
    """Return the smallest and the largest corner of the box around a shape, (2, 3) mm."""
    box = shape.BoundingBox()
    return np.array([[box.xmin, box.ymin, box.zmin], [box.xmax, box.ymax, box.zmax]])


def _document(path: str) -> Any:
    document = TDocStd_Document(TCollection_ExtendedString("bladecad"))
    reader = STEPCAFControl_Reader()
    reader.SetColorMode(True)
    reader.SetNameMode(True)
    if reader.ReadFile(path) != IFSelect_ReturnStatus.IFSelect_RetDone:
        raise ExportError(f"{path} cannot be read as STEP; is it there, and whole?")
    if not reader.Transfer(document):
        raise ExportError(f"{path} is STEP, but nothing in it turns into a shape")
    return document


def _roots(document: Any) -> list[Any]:
    labels = TDF_LabelSequence()
    XCAFDoc_DocumentTool.ShapeTool_s(document.Main()).GetFreeShapes(labels)
    return list(labels)


def _content(document: Any, product: str, shapes: list[cq.Shape]) -> StepFile:
    shape = shapes[0] if len(shapes) == 1 else cq.Compound.makeCompound(shapes)
    labels = _face_labels(document, shape)
    return StepFile(
        shape=shape,
        product=product,
        solids=len(shape.Solids()),
        faces=MappingProxyType({name: face for name, (face, _) in labels.items()}),
        colours=MappingProxyType(_colours(labels)),
        valid=shape.isValid(),
        volume=volume(shape),
        bounds=bounds(shape),
    )


def _face_labels(document: Any, shape: cq.Shape) -> dict[str, tuple[cq.Face, Any]]:
    tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    found = {}
    for face in shape.Faces():
        label = TDF_Label()
        if tool.Search(face.wrapped, label) and _text(label):
            found[_text(label)] = (face, label)
    return found


def _colours(labels: Mapping[str, tuple[cq.Face, Any]]) -> dict[str, tuple[float, float, float]]:
    found = {}
    for name, (_, label) in labels.items():
        colour = Quantity_Color()
        if XCAFDoc_ColorTool.GetColor_s(label, XCAFDoc_ColorType.XCAFDoc_ColorSurf, colour):
            found[name] = tuple(colour.Values(Quantity_TypeOfColor.Quantity_TOC_sRGB))
    return found


def _text(label: Any) -> str:
    """The name of a label, "" without one; asked for an attribute it lacks, the kernel crashes."""
    if not label.IsAttribute(TDataStd_Name.GetID_s()):
        return ""
    attribute = TDataStd_Name()
    label.FindAttribute(TDataStd_Name.GetID_s(), attribute)
    return str(attribute.Get().ToExtString())
