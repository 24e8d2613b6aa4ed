"""The model file: the flows themselves as JSON, read back bit by bit with numpy alone."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Final, get_args

import numpy as np

from bladecad.arrays import Array
from bladecad.data.sections import Axis, Machine, Row
from bladecad.errors import BladecadError, DataError
from bladecad.export.model.bases import START, read_basis, write_basis
from bladecad.export.text import write_json
from bladecad.fit.sidefit import SideFit
from bladecad.surface.blade import BladeSurface, EdgeKind, Law

FAMILY: Final = "bladecad-model"
VERSION: Final = 1
WALLS: Final = ("hub", "shroud")


def save(
    surface: BladeSurface,
    path: str | os.PathLike[str],
    *,
    provenance: Mapping[str, object] | None = None,
    machine: Machine | None = None,
) -> None:
    """Write a blade surface as a model file; `docs/files.md` says what stands in it.

    Parameters
    ----------
    surface : BladeSurface
    path : path
        Replaced when it exists; written beside first and then renamed.
    provenance : mapping, optional
        Where the blade came from; kept, never read back.
    machine : Machine, optional
        Axis, blade count, hub and shroud, where they are known; `load_machine` reads them back.

    Raises
    ------
    ExportError
        If the file cannot be written.
    """
    model = {
        "schema": f"{FAMILY}/{VERSION}",
        "unit": "mm",
        "provenance": dict(provenance or {}),
        **({"machine": _write_machine(machine)} if machine else {}),
        "law": surface.law,
        "edges": {"le": surface.le, "te": surface.te},
        "span": surface.span,
        "suction": _write_side(surface.suction),
        "pressure": _write_side(surface.pressure),
    }
    write_json(model, path)


def load(path: str | os.PathLike[str]) -> BladeSurface:
    """Read a model file back: the same surface, bit by bit, in need of numpy alone.

    Raises
    ------
    DataError
        If the file is no model file, is broken, or was written by a newer bladecad.
    """
    model = _parsed(Path(path))
    try:
        return BladeSurface(
            np.array(model["span"], dtype=np.float64),
            _read_side(model["suction"]),
            _read_side(model["pressure"]),
            _one_of(Law, model["law"]),
            _one_of(EdgeKind, model["edges"]["le"]),
            _one_of(EdgeKind, model["edges"]["te"]),
        )
    except KeyError as error:
        raise DataError(f"{path}: the model has no {error.args[0]!r}; export it again") from error
    except (TypeError, ValueError, BladecadError) as error:
        raise DataError(f"{path}: the model is broken: {error}; export it again") from error


def load_machine(path: str | os.PathLike[str]) -> Machine | None:
    """Read the machine round the blade of a model file, None where it does not say.

    Raises
    ------
    DataError
        As `load`.
    """
    said = _parsed(Path(path)).get("machine")
    if said is None:
        return None
    try:
        hub, shroud = (np.array(said[k], dtype=np.float64).reshape(-1, 2) for k in WALLS)
        return Machine(_one_of(Axis, said["axis"]), Row(said["blade_count"], hub, shroud))
    except (KeyError, TypeError, ValueError, BladecadError) as error:
        raise DataError(f"{path}: the machine is broken: {error}; export it again") from error


def _write_machine(machine: Machine) -> dict[str, object]:
    row = machine.row
    walls = {"hub": row.hub, "shroud": row.shroud}
    return {"axis": machine.axis, "blade_count": row.blade_count, **walls}


def _write_side(side: SideFit) -> dict[str, object]:
    bases = [write_basis(basis) for basis in side.bases]
    return {"bases": bases, "C": side.coefficients, "X0": side(START)[:, 0]}


def _read_side(side: Mapping[str, Any]) -> SideFit:
    C: Array = np.array(side["C"], dtype=np.float64)
    bases = tuple(read_basis(entry) for entry in side["bases"])
    if len(bases) not in (1, len(C)):
        raise DataError(f"{len(bases)} bases for {len(C)} sections; it takes one, or one a section")
    return SideFit(bases, C)


def _one_of(choices: Any, value: Any) -> Any:
    if value not in get_args(choices):
        raise DataError(f'"{value}" is none of {", ".join(get_args(choices))}')
    return value


def _parsed(path: Path) -> dict[str, Any]:
    try:
        model = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise DataError(f"{path} cannot be read: {error.strerror}; check the path") from error
    except UnicodeDecodeError as error:
        raise DataError(f"{path} is no text, let alone a model file; export it again") from error
    except json.JSONDecodeError as error:
        raise DataError(
            f"{path}, line {error.lineno}: {error.msg}; the file is cut off or was edited, "
            "export it again"
        ) from error
    family, _, version = str(model.get("schema") if isinstance(model, dict) else "").partition("/")
    if family != FAMILY or not version.isdigit():
        raise DataError(f'{path} is no model file: its "schema" should be "{FAMILY}/{VERSION}"')
    if int(version) > VERSION:
        raise DataError(
            f'{path} was written by a newer bladecad, "{family}/{version}"; this one reads up to '
            f'"{FAMILY}/{VERSION}": update bladecad'
        )
    return dict(model)
