"""IGES for older CAM: one solid as a boundary representation, its faces named and coloured, mm."""

from __future__ import annotations

import os
import unicodedata
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final

from OCP.IGESCAFControl import IGESCAFControl_Writer
from OCP.TCollection import TCollection_HAsciiString

from bladecad.brep.kernel import kernel
from bladecad.brep.solid import Solid
from bladecad.brep.statics import statics
from bladecad.errors import ExportError
from bladecad.export.cad.cad_document import document

SETTINGS: Final[Mapping[str, str]] = {
    "write.iges.unit": "MM",
    "xstep.cascade.unit": "MM",
    "write.iges.brep.mode": "BRep",
    "write.iges.plane.mode": "Plane",
    "write.precision.mode": "Average",
}


def write_iges(solid: Solid, path: str | os.PathLike[str], *, name: str) -> None:
    """Write the blade as IGES 5.3.

    Parameters
    ----------
    solid : Solid
        In mm; its face names (entity 406, form 15), colours (314) and layers, which are numbers in
        IGES, go into the file.
    path : path
    name : str
        Of the solid and of the product. IGES knows ASCII alone: accents are left out, and what
        is no letter then becomes "_".

    Raises
    ------
    ExportError
        If the name is blank or the kernel does not write.

    Notes
    -----
    The solid is entity 186, manifold solid B-rep; as loose trimmed surfaces, the kernel's default,
    the receiver would have to sew them. The kernel writes nine digits, which moves a blade of
    300 mm by less than a nanometre, and by some along itself where knots are close.
    """
    name = ascii_name(name)
    path = Path(path)
    try:
        with statics(SETTINGS), kernel(f"writing {path.name}"):
            writer = IGESCAFControl_Writer()
            for mode in (writer.SetNameMode, writer.SetColorMode, writer.SetLayerMode):
                mode(True)
            if not writer.Transfer(document(solid, name)):
                raise ExportError(f"the CAD kernel does not turn the solid into IGES for {path}")
            writer.ComputeModel()
            _head(writer.Model(), path.name, name)
            with path.open("wb"):
                pass  # says why a file cannot be written, which the kernel does not
            if not writer.Write(str(path)):
                raise ExportError(f"the CAD kernel does not write {path}")
    except OSError as error:
        raise ExportError(f"{path} cannot be written: {error.strerror}") from error


def _head(model: Any, file: str, name: str) -> None:
    """Say in the header what the file is; the kernel would put the user's login there."""
    head, maker = model.GlobalSection(), f"bladecad {version('bladecad')}"
    head.SetFileName(TCollection_HAsciiString(ascii_name(file)))
    head.SetSendName(TCollection_HAsciiString(name))
    head.SetReceiveName(TCollection_HAsciiString(name))
    head.SetSystemId(TCollection_HAsciiString(maker))
    head.SetAuthorName(TCollection_HAsciiString(""))
    head.SetCompanyName(TCollection_HAsciiString(""))
    model.SetGlobalSection(head)


def ascii_name(name: str) -> str:
    """Spell a name in printable ASCII."""
    if not name.strip():
        raise ExportError("an IGES product needs a name")
    bare = unicodedata.normalize("NFKD", name.strip())
    kept = (c for c in bare if not unicodedata.combining(c))
    return "".join(c if c.isascii() and c.isprintable() else "_" for c in kept)
