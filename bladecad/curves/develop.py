"""Sections laid flat: the plane of a planar section, or its stream surface rolled out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, final

import numpy as np

from bladecad.arrays import Array, Points, Vector, seal

Kind = Literal["plane", "revolution"]
PLANAR = 1e-4  # rms distance from the plane over the size: measured planes are flatter
MERIDIAN_DEGREE = 6
ACROSS = 0.1  # sine of the angle to the normal below which a direction is not in the plane


@final
@dataclass(frozen=True, eq=False)
class Flat:
    """A section laid flat without bending angles.

    points : (n, 2) float, mm; first column along the machine axis, outwards in a plane across it
    scale  : (n,) float; true length over flat length there, 1 in a plane
    kind   : "plane", or "revolution" for a surface of revolution about the machine axis
    misfit : rms distance of the points from that plane or surface, mm
    """

    points: Points
    scale: Vector
    kind: Kind
    misfit: float

    def __post_init__(self) -> None:
        n = len(self.points)
        seal(self, points=(n, 2), scale=(n,))


def develop(points: Points, axis: int) -> Flat:
    """Lay a section flat, by whichever of plane and surface of revolution holds it better.

    Parameters
    ----------
    points : (n, 3) float, mm
    axis : {0, 1, 2}
        Column of the machine axis.

    Notes
    -----
    A surface of revolution is rolled out conformally, (integral dm / r, -theta) times the mean
    radius, so that inscribed circles stay circles and angles stay angles. Both are seen from the
    same side: from outside on a cylinder, from the inlet on a disc.
    """
    plane = _plane(points, axis)
    if plane.misfit <= PLANAR * _size(points):
        return plane
    revolution = _revolution(points, axis)
    return revolution if revolution.misfit < plane.misfit else plane


def cylindrical(points: Points, axis: int) -> tuple[Vector, Vector, Vector]:
    """Axial position, radius and polar angle (radians, without jumps) about the machine axis."""
    z = points[:, axis]
    x, y = points[:, (axis + 1) % 3], points[:, (axis + 2) % 3]
    middle = np.arctan2(y.mean(), x.mean())
    theta = np.arctan2(y, x) - middle
    return z, np.hypot(x, y), np.mod(theta + np.pi, 2 * np.pi) - np.pi + middle


def frame(points: Points) -> tuple[Points, Array, Vector]:
    """Centroid, principal directions as rows (longest first), and rms extent along each."""
    centre = points.mean(axis=0)
    _, extent, rows = np.linalg.svd(points - centre, full_matrices=False)
    return centre, rows, extent / np.sqrt(len(points))


def _size(points: Points) -> float:
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def _plane(points: Points, axis: int) -> Flat:
    centre, rows, extent = frame(points)
    normal = rows[2]
    e1 = _in_plane(np.eye(3)[axis], normal)
    outwards = np.where(np.arange(3) == axis, 0.0, centre)
    outwards = outwards / (np.linalg.norm(outwards) or 1.0)
    e1 = e1 if np.linalg.norm(e1) > ACROSS else _in_plane(outwards, normal)
    e1 = rows[0] if np.linalg.norm(e1) < ACROSS else e1 / np.linalg.norm(e1)
    e2 = np.cross(normal, e1)
    e2 = e2 if normal @ (outwards - np.eye(3)[axis]) >= 0 else -e2  # as a rolled out surface
    flat = (points - centre) @ np.stack([e1, e2]).T
    return Flat(flat, np.ones(len(points)), "plane", float(extent[2]))


def _in_plane(direction: Vector, normal: Vector) -> Vector:
    return np.asarray(direction - (direction @ normal) * normal)


def _revolution(points: Points, axis: int) -> Flat:
    z, r, theta = cylindrical(points, axis)
    zr = np.column_stack([z, r])
    centre = zr.mean(axis=0)
    e, n = np.linalg.svd(zr - centre, full_matrices=False)[2]
    e = e if e.sum() >= 0 else -e  # inlet to outlet: with the axis, or outwards
    x = (zr - centre) @ e
    fit, _ = np.polynomial.Polynomial.fit(x, (zr - centre) @ n, MERIDIAN_DEGREE, full=True)
    misfit = float(np.sqrt(np.mean(((zr - centre) @ n - fit(x)) ** 2)))
    fine = np.linspace(x.min(), x.max(), 2001)
    radius = centre[1] + e[1] * fine + n[1] * fit(fine)
    if radius.min() <= 0:
        return Flat(np.column_stack([x, theta]), np.ones(len(x)), "revolution", np.inf)
    rate = np.hypot(1.0, fit.deriv()(fine)) / radius
    steps = 0.5 * (rate[1:] + rate[:-1]) * np.diff(fine)
    m = np.interp(x, fine, np.concatenate([[0.0], np.cumsum(steps)]))
    mean = float(r.mean())
    flat = mean * np.column_stack([m - m.mean(), theta.mean() - theta])
    return Flat(flat, r / mean, "revolution", misfit)
