"""What the report says of the fits: what they moved, how well it is known, what they absorbed."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from bladecad.deviation.registering.registration import Registration
    from bladecad.deviation.sectioning.section_fit import SectionFit

Report = dict[str, Any]


def registration_numbers(registration: Registration) -> Report:
    """Return the transform, and one sigma of each of its six freedoms, in mm and degrees."""
    sigma = np.sqrt(np.maximum(np.diag(registration.covariance), 0.0))
    T = registration.T_nominal_scan
    return {
        "fit": registration.kind,
        "locked": list(registration.locked),
        "T_nominal_scan": T,
        "shift_mm": _moved(registration),
        "rotation_deg": rotation_deg(T),
        "centre_mm": registration.centre,
        "covariance": registration.covariance,
        "sigma_shift_mm": sigma[:3],
        "sigma_rotation_deg": np.degrees(sigma[3:]),
        "rms_mm": registration.rms,
        "largest_mm": registration.largest,
        "points": registration.used,
        "far": registration.far,
        "steps": registration.steps,
    }


def rotation_deg(T: Any) -> float:
    """Return the angle of a rigid motion, degrees, exact for small angles too."""
    R = np.asarray(T)[:3, :3]
    axial = np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
    return float(np.degrees(np.arctan2(np.linalg.norm(axial), np.trace(R) - 1.0)))


def section_fit_numbers(fit: SectionFit) -> Report:
    """Return what a fit of a section moved, and the deviations before and after it."""
    keys = ("min_mm", "max_mm", "rms_mm")
    return {
        "fit": fit.kind,
        "shift_mm": fit.shift,
        "twist_deg": float(np.degrees(fit.twist)),
        "before": dict(zip(keys, fit.before, strict=True)),
        "after": dict(zip(keys, fit.after, strict=True)),
    }


def _moved(registration: Registration) -> Any:
    """How far the centre was moved, (3,) mm: the shift of T alone depends on the origin."""
    T = registration.T_nominal_scan
    scanned = np.linalg.solve(T, np.append(registration.centre, 1.0))[:3]
    return np.asarray(registration.centre) - scanned
