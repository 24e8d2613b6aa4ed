"""The blade as it is made: cold or hot, scaled, mirrored; flows are turned, nothing is fitted."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final, cast, final

import numpy as np

from bladecad.arrays import Array, Vector, frozen
from bladecad.cam.stacking import StackingAxis, stacking_axis
from bladecad.data.sections import Axis
from bladecad.errors import ToleranceError
from bladecad.fit.orbit import Orbit
from bladecad.fit.sidefit import Basis, SideFit
from bladecad.fit.spectrum import Spectrum
from bladecad.surface.blade import BladeSurface

MOST_SHRINKAGE: Final = 20.0  # percent; castings shrink by one or two
MOST_UNTWIST: Final = 90.0  # degrees
SCALES: Final = (1e-3, 1e3)  # the least and the largest, beyond any change of unit


@final
@dataclass(frozen=True, eq=False)
class Variant:
    """What is done to a blade before it is cut, in this order: untwisted, scaled, mirrored.

    mirror  : axis whose coordinate changes its sign, or None
    scale   : factor about the origin, which the machine axis passes through
    untwist : degrees by which the tip is turned about the stacking axis, right-handed from hub to
              tip, sections below it in proportion to u; or a table of rows (u, degrees), linear
              between them and level beyond
    """

    mirror: Axis | None = None
    scale: float = 1.0
    untwist: float | Array = 0.0

    def __post_init__(self) -> None:
        if self.mirror not in (None, "x", "y", "z"):
            raise ToleranceError(f'mirror "{self.mirror}" is no axis; give x, y or z')
        if not SCALES[0] <= self.scale <= SCALES[1]:
            raise ToleranceError(
                f"a scale of {self.scale:g} is asked; it must lie between {SCALES[0]:g} and "
                f"{SCALES[1]:g}"
            )
        table = self._table()
        if table.ndim != 2 or table.shape[1] != 2:
            raise ToleranceError(f"untwist of shape {table.shape} is no table of (u, degrees)")
        if not np.isfinite(table).all():
            raise ToleranceError("untwist holds what is no number; give u and degrees")
        if table[:, 0].min() < 0.0 or table[:, 0].max() > 1.0:
            raise ToleranceError(
                f"untwist: u = {table[:, 0].min():g} to {table[:, 0].max():g} is asked, a blade "
                "has 0 (hub) to 1 (tip)"
            )
        if np.any(np.diff(table[:, 0]) <= 0):
            raise ToleranceError(f"untwist: span must rise from hub to tip, got {table[:, 0]}")
        if np.abs(table[:, 1]).max() > MOST_UNTWIST:
            raise ToleranceError(
                f"untwist of {np.abs(table[:, 1]).max():g} degrees; give {MOST_UNTWIST:g} at most"
            )
        if np.ndim(self.untwist):
            object.__setattr__(self, "untwist", frozen(table))

    @property
    def linear(self) -> Array:
        """Scale and mirror together, (3, 3)."""
        signs = [-1.0 if name == self.mirror else 1.0 for name in "xyz"]
        return self.scale * np.diag(signs)

    def turn(self, u: Vector) -> Vector:
        """Radians by which sections are turned."""
        table = self._table()
        return np.radians(np.interp(u, table[:, 0], table[:, 1]))

    def _table(self) -> Array:
        if np.ndim(self.untwist):
            return np.asarray(self.untwist, dtype=np.float64)
        return np.array([[0.0, 0.0], [1.0, self.untwist]], dtype=np.float64)


def shrunk(percent: float) -> float:
    """Scale of the form for a part that shrinks by some percent of the form, 1/(1 - s/100).

    Raises
    ------
    ToleranceError
        If the shrinkage is beyond 20 percent either way.
    """
    if not abs(percent) <= MOST_SHRINKAGE:
        raise ToleranceError(
            f"a shrinkage of {percent:g} percent is beyond {MOST_SHRINKAGE:g}; give it in percent"
        )
    return 1.0 / (1.0 - percent / 100.0)


def varied(surface: BladeSurface, variant: Variant) -> BladeSurface:
    """Return a blade scaled, mirrored, its sections turned.

    Exact: coefficients are multiplied, C -> C R^T, and the constant 1 in the state carries the
    shift. Between sections the law blends what was turned. Suction stays suction, u and t stay,
    and normals point out of the metal, for `outward` asks the volume.

    Parameters
    ----------
    surface : BladeSurface
    variant : Variant
    """
    moves = _moves(surface, variant)
    suction, pressure = (_side(side, *moves) for side in (surface.suction, surface.pressure))
    return replace(surface, suction=suction, pressure=pressure)


def _moves(surface: BladeSurface, variant: Variant) -> tuple[Array, Array]:
    """Matrix and shift of every section, (m, 3, 3) and (m, 3)."""
    angle = variant.turn(surface.span)
    if not angle.any():
        return np.broadcast_to(variant.linear, (len(angle), 3, 3)), np.zeros((len(angle), 3))
    axis = stacking_axis(surface)
    R = _rotations(axis, angle)
    shift = axis.point - R @ axis.point
    return variant.linear @ R, shift @ variant.linear.T


def _rotations(axis: StackingAxis, angle: Vector) -> Array:
    """Rodrigues' formula, R = 1 + sin K + (1 - cos) K^2, (m, 3, 3)."""
    x, y, z = axis.direction
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    sin, cos = (f(angle)[:, None, None] for f in (np.sin, np.cos))
    return np.asarray(np.eye(3) + sin * K + (1.0 - cos) * (K @ K))


def _side(side: SideFit, linear: Array, shift: Array) -> SideFit:
    C = np.einsum("mnx,myx->mny", side.coefficients, linear)
    if not shift.any():
        return replace(side, coefficients=C)
    bases, ones = zip(*(_with_one(basis) for basis in side.bases), strict=True)
    C = np.pad(C, [(0, 0), (0, bases[0].size - C.shape[1]), (0, 0)])
    return SideFit(bases, C + np.array(ones)[:, :, None] * shift[:, None])


def _with_one(basis: Basis) -> tuple[Basis, Vector]:
    """A basis that holds the constant 1, and its coefficients; an orbit gets it as a state."""
    if isinstance(basis, Orbit):
        A, z0 = np.pad(basis.A, [(0, 1), (0, 1)]), np.append(basis.z0, 1.0)
        return Orbit(A, z0), np.eye(len(z0))[-1]
    return basis, cast(Spectrum, basis).one
