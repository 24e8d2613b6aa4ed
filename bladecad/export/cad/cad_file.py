"""One file for CAD or CAM, in the format of its suffix: written, read back, confirmed."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Final, final

from bladecad.brep.confirm import Agreement, confirm
from bladecad.brep.reread import CadFile, Format, read_brep, read_iges, read_step
from bladecad.brep.solid import Solid
from bladecad.errors import ExportError
from bladecad.export.cad.brep_file import write_brep
from bladecad.export.cad.cad_suffix import cad_format
from bladecad.export.cad.iges import write_iges
from bladecad.export.cad.step import Schema, write_step

# mm; STEP has twelve digits, BREP all, IGES nine: knots that are close move points along the blade
DISTANCE: Final[Mapping[Format, float]] = {"STEP": 1e-6, "IGES": 2e-5, "BREP": 1e-6}


@final
@dataclass(frozen=True, eq=False)
class Written:
    """A file as it was read back.

    file      : what stands in it
    agreement : how far that is from the solid
    size      : bytes
    """

    file: CadFile
    agreement: Agreement
    size: int


def write_cad(
    solid: Solid,
    path: str | os.PathLike[str],
    *,
    name: str,
    schema: Schema = "AP242DIS",
    measure: Callable[[CadFile], None] = lambda _: None,
) -> Written:
    """Write a blade as STEP, IGES or BREP, and return what was read back.

    Parameters
    ----------
    solid : Solid
    path : path
        .step, .stp, .igs, .iges or .brep. Replaced when it exists; written in a hidden folder
        beside, read back, compared, measured, and then moved: on any failure it is as it was.
    name : str
        Of the product; BREP has none.
    schema : {"AP242DIS", "AP214IS"}
        Of STEP.
    measure : callable
        Given what was read back, before the file is moved.

    Raises
    ------
    ExportError
        If the suffix is another one, the file cannot be written, or what is read back is not the
        solid: one valid solid with the same faces, names, volume and box.
    """
    path = Path(path)
    kind = cad_format(path)
    with _beside(path) as file:
        if kind == "STEP":
            write_step(solid, file, name=name, schema=schema)
            again = read_step(file)
        elif kind == "IGES":
            write_iges(solid, file, name=name)
            again = read_iges(file)
        else:
            write_brep(solid, file)
            again = read_brep(file, names=_in_order(solid))
        agreement = confirm(solid, again, distance=DISTANCE[kind])
        measure(again)
        return Written(again, agreement, file.stat().st_size)


@contextmanager
def _beside(path: Path) -> Iterator[Path]:
    """Give a file of the same name in a hidden folder, and move it if all went well."""
    folder = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        folder.mkdir()
        yield folder / path.name
        (folder / path.name).replace(path)
    except OSError as error:
        raise ExportError(f"{path} cannot be written: {error.strerror}") from error
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def _in_order(solid: Solid) -> list[str]:
    """The names of the faces in the order of the shape."""
    return [
        next(name for name, own in solid.faces.items() if own.isSame(face))
        for face in solid.shape.Faces()
    ]
