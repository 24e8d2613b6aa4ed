"""Names, colours and layers of faces, as they stand in a document of the kernel."""

from __future__ import annotations

from typing import Any

import cadquery as cq
from OCP.Quantity import Quantity_Color, Quantity_TypeOfColor
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDF import TDF_Label, TDF_LabelSequence
from OCP.TDocStd import TDocStd_Document
from OCP.XCAFDoc import XCAFDoc_ColorType, XCAFDoc_DocumentTool


def empty_document() -> Any:
    """Return a document to read a file into."""
    return TDocStd_Document(TCollection_ExtendedString("bladecad"))


def roots(document: Any) -> list[Any]:
    """Return the labels of all shapes that no other shape holds."""
    labels = TDF_LabelSequence()
    XCAFDoc_DocumentTool.ShapeTool_s(document.Main()).GetFreeShapes(labels)
    return list(labels)


def face_name(document: Any, face: cq.Face) -> str:
    """Return the name of a face, "" without one."""
    tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    label = TDF_Label()
    return text(label) if tool.Search(face.wrapped, label) else ""


def face_colour(document: Any, face: cq.Face) -> tuple[float, float, float] | None:
    """Return the sRGB colour of a face, None without one."""
    tool = XCAFDoc_DocumentTool.ColorTool_s(document.Main())
    colour = Quantity_Color()
    for kind in (XCAFDoc_ColorType.XCAFDoc_ColorSurf, XCAFDoc_ColorType.XCAFDoc_ColorGen):
        if tool.GetColor(face.wrapped, kind, colour):
            red, green, blue = colour.Values(Quantity_TypeOfColor.Quantity_TOC_sRGB)
            return red, green, blue
    return None


def face_layer(document: Any, face: cq.Face) -> str:
    """Return the first layer a face lies on, "" without one."""
    tool = XCAFDoc_DocumentTool.LayerTool_s(document.Main())
    names = tool.GetLayers(face.wrapped)
    return str(names.Value(1).ToExtString()) if names is not None and names.Length() else ""


def text(label: Any) -> str:
    """The name of a label, "" without one; asked for an attribute it lacks, the kernel crashes."""
    if not label.IsAttribute(TDataStd_Name.GetID_s()):
        return ""
    attribute = TDataStd_Name()
    label.FindAttribute(TDataStd_Name.GetID_s(), attribute)
    return str(attribute.Get().ToExtString())
