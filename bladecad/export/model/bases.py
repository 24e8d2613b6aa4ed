"""How each kind of basis stands in the model file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final, final

import numpy as np

from bladecad.errors import DataError
from bladecad.export.model.blocks import Block, block, blocks
from bladecad.fit.orbit import Orbit
from bladecad.fit.sidefit import Basis
from bladecad.fit.spectrum import Spectrum

START: Final = np.zeros(1)


@final
@dataclass(frozen=True)
class Kind:
    """One kind of basis and the doors to the file and back.

    basis : its class
    own   : the numbers it is made of, beyond its flow
    flow  : its blocks
    read  : the basis again, bit by bit
    """

    basis: type
    own: Callable[[Any], dict[str, object]]
    flow: Callable[[Any], list[Block]]
    read: Callable[[Mapping[str, Any]], Basis]


def _spectrum(basis: Spectrum) -> dict[str, object]:
    return {"degree": basis.degree, "le": basis.le, "te": basis.te, "knots": basis.knots}


def _read_spectrum(entry: Mapping[str, Any]) -> Basis:
    le, te = (np.array(entry[end], dtype=np.float64).reshape(-1, 2) for end in ("le", "te"))
    return Spectrum(int(entry["degree"]), le, te, np.array(entry["knots"], dtype=np.float64))


def _orbit_flow(basis: Orbit) -> list[Block]:
    return [block(0, (0.0, 1.0), 0.0, basis.A, basis.z0)]


def _read_orbit(entry: Mapping[str, Any]) -> Basis:
    flow = entry["flow"][0]
    return Orbit(np.array(flow["A"], dtype=np.float64), np.array(flow["z"], dtype=np.float64))


KINDS: Final[dict[str, Kind]] = {
    "spectrum": Kind(Spectrum, _spectrum, blocks, _read_spectrum),
    "orbit": Kind(Orbit, lambda _: {}, _orbit_flow, _read_orbit),
}


def write_basis(basis: Basis) -> dict[str, object]:
    """Return a basis as it stands in the file: its kind, its numbers, z(0), and its flow."""
    for name, kind in KINDS.items():
        if isinstance(basis, kind.basis):
            z0, flow = basis(START)[0], kind.flow(basis)
            return {"kind": name, **kind.own(basis), "z0": z0, "flow": flow}
    raise DataError(f"a basis of {type(basis).__name__} has no place in the model file")


def read_basis(entry: Mapping[str, Any]) -> Basis:
    """Return the basis that was written."""
    if entry["kind"] not in KINDS:
        raise DataError(f'a basis of kind "{entry["kind"]}" is unknown, only {", ".join(KINDS)}')
    return KINDS[entry["kind"]].read(entry)
