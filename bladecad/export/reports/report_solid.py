"""What the report says of the solid and its triangles: witnesses, and distances from S."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import numpy as np

from bladecad.arrays import Vector
from bladecad.brep.names import PRESSURE_SIDE, SUCTION_SIDE, FaceName
from bladecad.export.cad.stl import StlFile
from bladecad.export.product import Product
from bladecad.surface.blade import SideName
from bladecad.surface.loft import graded
from bladecad.surface.patch import SplinePatch

if TYPE_CHECKING:
    from bladecad.brep.confirm import Agreement

FACES: Final[tuple[tuple[FaceName, SideName], ...]] = (
    (SUCTION_SIDE, "suction"),
    (PRESSURE_SIDE, "pressure"),
)
U: Final = np.linspace(0.0, 1.0, 41)
T: Final = graded(301)
EDGES: Final = (("leading", 0.0), ("trailing", 1.0))


def solid_numbers(product: Product, step: Agreement) -> dict[str, Any]:
    """Return the witnesses, the distance of the kernel's faces from S, and the file read back."""
    solid = product.solid
    w = solid.witnesses
    return {
        "faces": {name: face.geomType() for name, face in solid.faces.items()},
        "valid": w.valid,
        "vertices_edges_faces": list(w.counts),
        "expected": list(w.expected),
        "euler": w.euler,
        "free_edges": w.free_edges,
        "edge_tolerance_mm": w.edge_tolerance,
        "volume_mm3": w.volume,
        "quadrature_mm3": w.quadrature,
        "volume_error": w.volume_error,
        "area_mm2": w.area,
        "poles": list(product.loft.suction.poles.shape[:2]),
        "to_surface_mm": brep_distance(product),
        "edge_angle_deg": edge_angles(product),
        "step_read_back": {
            "volume_error": step.volume_error,
            "drift_mm": step.drift,
            "shift_mm": step.shift,
        },
    }


def brep_distance(product: Product) -> float:
    """Largest distance of the kernel's own side faces from S at equal (u,t), mm."""
    from bladecad.brep.solid import sample_face

    return max(
        float(
            np.linalg.norm(
                sample_face(product.solid, face, U, T) - product.surface(side, U, T), axis=2
            ).max()
        )
        for face, side in FACES
    )


def edge_angles(product: Product) -> dict[str, float]:
    """Largest angle between the normals of both sides along each round edge, degrees."""
    kinds = (product.surface.le, product.surface.te)
    sides = (product.loft.suction, product.loft.pressure)
    return {
        name: _angle(sides, np.array([end]))
        for (name, end), kind in zip(EDGES, kinds, strict=True)
        if kind == "round"
    }


def _angle(sides: tuple[SplinePatch, SplinePatch], t: Vector) -> float:
    """Between both sides' planes; the sides run in opposite directions through the edge."""
    u = np.linspace(0.0, 1.0, 201)
    S, P = (np.cross(side(u, t, 1, 0)[:, 0], side(u, t, 0, 1)[:, 0]) for side in sides)
    sine = np.linalg.norm(np.cross(S, P), axis=1)
    return float(np.degrees(np.arctan2(sine, np.abs(np.einsum("ux,ux->u", S, P))).max()))


def mesh_numbers(product: Product, stl: StlFile) -> dict[str, Any]:
    """Return the size of the mesh, its chord error, and its volume against the solid's."""
    mesh, volume = product.mesh, product.solid.witnesses.volume
    return {
        "vertices": len(mesh.vertices),
        "triangles": {name: len(triangles) for name, triangles in mesh.faces.items()},
        "chord_error_asked_mm": product.settings.chord_error,
        "chord_error_mm": mesh.chord_error,
        "volume_mm3": mesh.volume,
        "volume_error": abs(mesh.volume / volume - 1.0),
        "watertight": stl.watertight,
        "stl_triangles": stl.triangles,
        "stl_volume_error": abs(stl.volume / volume - 1.0),
    }
