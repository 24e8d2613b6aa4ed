"""What STEP and IGES are written from: the solid, and name, colour and layer of its faces."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Final

from OCP.Quantity import Quantity_Color, Quantity_TypeOfColor
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.XCAFDoc import XCAFDoc_ColorType, XCAFDoc_DocumentTool

from bladecad.brep.names import (
    AIRFOIL,
    HUB,
    LEADING_EDGE,
    PRESSURE_SIDE,
    SUCTION_SIDE,
    TIP,
    TRAILING_EDGE,
)
from bladecad.brep.passage_solid import PassageSolid
from bladecad.brep.solid import Solid

COLOURS: Final[Mapping[str, tuple[float, float, float]]] = {  # sRGB, as seen on the screen
    SUCTION_SIDE: (0.26, 0.52, 0.76),
    PRESSURE_SIDE: (0.86, 0.44, 0.32),
    HUB: (0.55, 0.55, 0.58),
    TIP: (0.78, 0.78, 0.80),
    LEADING_EDGE: (0.95, 0.77, 0.28),
    TRAILING_EDGE: (0.45, 0.66, 0.38),
    AIRFOIL: (0.60, 0.63, 0.70),
    "BLADE_SUCTION": (0.26, 0.52, 0.76),
    "BLADE_PRESSURE": (0.86, 0.44, 0.32),
    "BLADE_LE": (0.95, 0.77, 0.28),
    "BLADE_TE": (0.45, 0.66, 0.38),
    "INLET": (0.45, 0.70, 0.90),
    "OUTLET": (0.93, 0.60, 0.45),
}
OTHER: Final = (0.70, 0.74, 0.70)


def document(solid: Solid | PassageSolid, name: str, spelt: Callable[[str], str] = str) -> Any:
    """Return a document of the kernel with one solid at its root.

    Parameters
    ----------
    solid : Solid, PassageSolid
    name : str
        Of the product.
    spelt : callable
        How the format spells a name.

    Notes
    -----
    Each face is named, has its colour, and lies on a layer of its own that has its name: CAM
    programs differ in which of the three they read.
    """
    made = TDocStd_Document(TCollection_ExtendedString("bladecad"))
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(made.Main())
    colours = XCAFDoc_DocumentTool.ColorTool_s(made.Main())
    layers = XCAFDoc_DocumentTool.LayerTool_s(made.Main())
    root = shapes.AddShape(solid.shape.wrapped, False)
    _name(root, spelt(name))
    for face_name, face in solid.faces.items():
        label = shapes.AddSubShape(root, face.wrapped)
        _name(label, face_name)
        colours.SetColor(label, _colour(face_name), XCAFDoc_ColorType.XCAFDoc_ColorSurf)
        layers.SetLayer(label, TCollection_ExtendedString(face_name))
    return made


def _name(label: Any, text: str) -> None:
    TDataStd_Name.Set_s(label, TCollection_ExtendedString(text, True))


def _colour(face_name: str) -> Quantity_Color:
    return Quantity_Color(*COLOURS.get(face_name, OTHER), Quantity_TypeOfColor.Quantity_TOC_sRGB)
