"""STEP for CAM and CAD: one solid at the root, its faces named and coloured, in mm."""

from __future__ import annotations

import os
from collections.abc import Mapping
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final, Literal, TypeAlias

from OCP.APIHeaderSection import APIHeaderSection_MakeHeader
from OCP.IFSelect import IFSelect_ReturnStatus
from OCP.STEPCAFControl import STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_StepModelType
from OCP.TCollection import TCollection_HAsciiString

from bladecad.brep.kernel import kernel
from bladecad.brep.passage_solid import PassageSolid
from bladecad.brep.solid import Solid
from bladecad.brep.statics import statics
from bladecad.errors import ExportError
from bladecad.export.cad.cad_document import document
from bladecad.written import beside

Schema: TypeAlias = Literal["AP242DIS", "AP214IS"]

SETTINGS: Final[Mapping[str, str]] = {
    "write.step.unit": "MM",
    "xstep.cascade.unit": "MM",
    "write.stepcaf.subshapes.name": "On",
    "write.surfacecurve.mode": "On",
    "write.precision.mode": "Average",
    "write.step.assembly": "Off",
    "write.step.nonmanifold": "Off",
}


def write_step(
    solid: Solid | PassageSolid,
    path: str | os.PathLike[str],
    *,
    name: str,
    schema: Schema = "AP242DIS",
) -> None:
    """Write a blade, or the passage round it, as STEP, or nothing at all.

    Parameters
    ----------
    solid : Solid, PassageSolid
        In mm; the names, colours and layers of its faces go into the file.
    path : path
        Replaced when it exists; written beside first and then renamed.
    name : str
        The product name that CAD programs show, any script.
    schema : {"AP242DIS", "AP214IS"}
        AP242 is today's; AP214 for older programs.

    Raises
    ------
    ExportError
        If the folder is missing or closed to us, the name is blank, or the kernel does not write.

    Notes
    -----
    cadquery's `exportStepMeta` writes an empty file for a solid at the root, and nests it as a
    child; hence this writer.
    """
    if not name.strip():
        raise ExportError("a STEP product needs a name; the kernel would give it its own")
    path = Path(path)
    schemas = {**SETTINGS, "write.step.schema": schema}
    with beside(path) as file, statics(schemas), kernel(f"writing {path.name}"):
        _write(_transferred(document(solid, name, _directives), path.name), file)


def _transferred(document: Any, title: str) -> STEPCAFControl_Writer:
    writer = STEPCAFControl_Writer()
    writer.SetColorMode(True)
    writer.SetNameMode(True)
    writer.SetLayerMode(True)
    if not writer.Transfer(document, STEPControl_StepModelType.STEPControl_AsIs):
        raise ExportError(f"the CAD kernel does not turn the solid into STEP for {title}")
    header = APIHeaderSection_MakeHeader(writer.ChangeWriter().Model())
    header.SetName(TCollection_HAsciiString(_directives(title)))
    header.SetAuthorValue(1, TCollection_HAsciiString(""))
    header.SetOrganizationValue(1, TCollection_HAsciiString(""))
    header.SetOriginatingSystem(TCollection_HAsciiString(f"bladecad {version('bladecad')}"))
    return writer


def _write(writer: STEPCAFControl_Writer, path: Path) -> None:
    with path.open("wb"):
        pass  # says why a file cannot be written, which the kernel does not
    status = writer.Write(str(path))
    if status != IFSelect_ReturnStatus.IFSelect_RetDone:
        raise ExportError(f"the CAD kernel does not write {path}: {status.name}")


def _directives(text: str) -> str:
    """Spell what is not ASCII as ISO 10303-21 wants it, which the kernel leaves raw."""
    return "".join(c if ord(c) < 128 else _directive(ord(c)) for c in text)


def _directive(code: int) -> str:
    return f"\\X2\\{code:04X}\\X0\\" if code < 0x10000 else f"\\X4\\{code:08X}\\X0\\"
