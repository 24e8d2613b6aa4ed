"""What the report says of the fit: its size, its errors on every section, its eigenvalues."""

from __future__ import annotations

from typing import Any

import numpy as np

from bladecad.arrays import Array
from bladecad.fit.blade import BladeFit
from bladecad.fit.judge import SideErrors
from bladecad.fit.left_out import LeftOut
from bladecad.fit.orbit import Orbit
from bladecad.fit.sidefit import Basis, SideFit
from bladecad.fit.spectrum import Spectrum


def fit_numbers(
    fit: BladeFit, *, left_out: LeftOut | None = None, noise: float | None = None
) -> dict[str, Any]:
    """Return model, order and errors; distances are from the densified lines, in mm."""
    errors = fit.errors
    side, i, t = errors.worst()
    return {
        "model": fit.model,
        "order": None if fit.order is None else vars(fit.order),
        "coefficients": {
            "suction": fit.suction.bases[0].size,
            "pressure": fit.pressure.bases[0].size,
        },
        "spectra": {"suction": len(fit.suction.bases), "pressure": len(fit.pressure.bases)},
        "rank": fit.rank,
        "free": fit.free,
        "condition": fit.condition,
        "tolerance_mm": fit.tolerance,
        "margin": fit.margin,
        "max_mm": errors.largest,
        "rms_mm": errors.rms,
        "worst": {"side": side, "section": fit.lines.names[i], "t": t},
        "at_points_mm": errors.at_points,
        "edge_speed": list(errors.speed),
        "left_out": None if left_out is None else _left_out(left_out),
        "noise_mm": noise,
        "reason": fit.reason,
        "suction": _side(fit.lines.names, errors.suction),
        "pressure": _side(fit.lines.names, errors.pressure),
    }


def _left_out(left_out: LeftOut) -> dict[str, Any]:
    return {"max_mm": left_out.largest, "rms_mm": left_out.rms, "points": left_out.points}


def _side(names: tuple[str, ...], errors: SideErrors) -> list[dict[str, Any]]:
    columns = zip(names, errors.largest, errors.rms, errors.place, errors.at_points, strict=True)
    keys = ("section", "max_mm", "rms_mm", "t", "at_points_mm")
    return [dict(zip(keys, row, strict=True)) for row in columns]


def eigenvalues(fit: BladeFit) -> dict[str, Any]:
    """Return the eigenvalues of A along the span, by side, each as [real, imaginary]."""
    return {
        name: _of_side(side, fit.lines.names)
        for name, side in (("suction", fit.suction), ("pressure", fit.pressure))
    }


def _of_side(side: SideFit, names: tuple[str, ...]) -> list[dict[str, Any]]:
    shared = len(side.bases) == 1
    return [
        {"section": "all" if shared else names[i], **_of_basis(basis)}
        for i, basis in enumerate(side.bases)
    ]


def _of_basis(basis: Basis) -> dict[str, Any]:
    if isinstance(basis, Spectrum):
        zeros = basis.size - 2 * (len(basis.le) + len(basis.te))
        return {"zeros": zeros, "le": _pairs(basis.le, -1.0), "te": _pairs(basis.te, 1.0)}
    if isinstance(basis, Orbit):
        values = np.linalg.eigvals(basis.A)
        return {"all": np.column_stack([values.real, values.imag])}
    return {}


def _pairs(pairs: Array, sign: float) -> Array:
    """Both roots of y'' = -2ay' - a^2(1+k)y, -a +- a sqrt(-k); of the reversed time for sign 1."""
    found = []
    for a, k in pairs:
        root = np.sqrt(complex(-k))
        found += [sign * a * (1.0 - root), sign * a * (1.0 + root)]
    return np.array([[value.real, value.imag] for value in found]).reshape(-1, 2)
