"""The faces of a STEP file, of any program, as plain arrays."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final, final

import cadquery as cq
import numpy as np
from numpy.typing import NDArray
from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import BRepBuilderAPI_NurbsConvert, BRepBuilderAPI_Transform
from OCP.BRepMesh import BRepMesh_IncrementalMesh
from OCP.BRepTools import BRepTools
from OCP.Geom import Geom_BSplineSurface
from OCP.gp import gp_Pnt, gp_Trsf
from OCP.TopAbs import TopAbs_Orientation
from OCP.TopLoc import TopLoc_Location

from bladecad.arrays import Array, Points, Vector, seal
from bladecad.brep.kernel import kernel
from bladecad.brep.reread import named_faces
from bladecad.errors import GeometryError
from bladecad.splines import basis

ON_BORDER: Final = 1e-6  # of the parameter range
TURN: Final = 0.3  # rad between neighbouring facets


@final
@dataclass(frozen=True, eq=False)
class FacePatch:
    """One face as a B-spline patch, rational or not; u and t are the kernel's U and V.

    name   : of the face in the file, "" without one
    poles  : (nu, nt, 3) float, mm
    weights : (nu, nt) float, 1 where the patch is not rational
    knots_u, knots_t : full knot vectors
    degree_u, degree_t : int
    """

    name: str
    poles: Array
    weights: Array
    knots_u: Vector
    knots_t: Vector
    degree_u: int
    degree_t: int

    def __post_init__(self) -> None:
        nu, nt, _ = np.shape(self.poles)
        seal(
            self,
            poles=(nu, nt, 3),
            weights=(nu, nt),
            knots_u=(nu + self.degree_u + 1,),
            knots_t=(nt + self.degree_t + 1,),
        )

    def __call__(self, u: Vector, t: Vector) -> Array:
        """X = sum N_k M_l w_kl P_kl / sum N_k M_l w_kl on the grid u x t, (len(u), len(t), 3)."""
        N = basis(self.knots_u, self.degree_u, np.asarray(u, dtype=np.float64), 0)
        M = basis(self.knots_t, self.degree_t, np.asarray(t, dtype=np.float64), 0)
        wP = self.weights[:, :, None] * self.poles
        X = np.einsum("ik,jl,klx->ijx", N, M, wP, optimize=True)
        w = np.einsum("ik,jl,kl->ij", N, M, self.weights, optimize=True)
        return np.asarray(X / w[:, :, None])


@final
@dataclass(frozen=True, eq=False)
class StepFace:
    """One face of a STEP file.

    name     : in the file, else "face 3" by its place there
    patch    : the face as a patch, None where its border is no rectangle of parameters
    vertices, triangles : the same as triangles, counter-clockwise from outside
    chord_error : mm, distance of the triangles from the face, measured at the middles of edges
    """

    name: str
    patch: FacePatch | None
    vertices: Points
    triangles: NDArray[np.int64]
    chord_error: float


@final
@dataclass(frozen=True, eq=False)
class StepFaces:
    """What stands in a STEP file, ready to be measured against."""

    faces: tuple[StepFace, ...]

    @cached_property
    def mesh(self) -> tuple[Points, NDArray[np.int64]]:
        """Vertices and triangles of all faces; each face has its own vertices."""
        return joined(self.faces)

    @property
    def usual_chord_error(self) -> float:
        """Of most of the triangles, mm."""
        errors = [face.chord_error for face in self.faces]
        return float(np.average(errors, weights=[len(face.triangles) for face in self.faces]))

    def patch(self, name: str) -> FacePatch | None:
        """The patch of the face of that name, None if there is none."""
        return next((face.patch for face in self.faces if face.name == name), None)


def joined(faces: Sequence[StepFace]) -> tuple[Points, NDArray[np.int64]]:
    """Return vertices and triangles of several faces as one mesh."""
    starts = np.cumsum([0, *(len(face.vertices) for face in faces)])
    corners = [face.triangles + k for face, k in zip(faces, starts[:-1], strict=True)]
    return np.concatenate([face.vertices for face in faces]), np.concatenate(corners)


def read_faces(
    path: str | os.PathLike[str], *, scale: float = 1.0, chord_error: float = 0.005
) -> StepFaces:
    """Read the faces of a STEP file as patches, and as triangles.

    Parameters
    ----------
    path : path
    scale : float
        Factor on all lengths, for files that call their unit wrongly.
    chord_error : float
        Asked of the triangles, mm.

    Raises
    ------
    ExportError
        If the file cannot be read as STEP, or holds no shape.
    """
    with kernel(f"reading {os.fspath(path)}"):
        faces = [(name, _scaled(face, scale)) for name, face in named_faces(path)]
        whole = cq.Compound.makeCompound([face for _, face in faces])
        BRepMesh_IncrementalMesh(whole.wrapped, chord_error, False, TURN, True)
        return StepFaces(
            tuple(_face(name or f"face {k}", face) for k, (name, face) in enumerate(faces, 1))
        )


def _face(name: str, face: cq.Face) -> StepFace:
    vertices, triangles, chord_error = _triangles(face)
    return StepFace(name, _patch(name, face), vertices, triangles, chord_error)


def _scaled(face: cq.Face, scale: float) -> cq.Face:
    if scale == 1.0:
        return face
    change = gp_Trsf()
    change.SetScale(gp_Pnt(0.0, 0.0, 0.0), scale)
    return cq.Face(BRepBuilderAPI_Transform(face.wrapped, change, True).Shape())


def _patch(name: str, face: cq.Face) -> FacePatch | None:
    """The face as a patch, None where its border is no rectangle of parameters."""
    if not _is_rectangle(face):
        return None
    u0, u1, t0, t1 = BRepTools.UVBounds_s(face.wrapped)
    surface = BRep_Tool.Surface_s(face.wrapped)
    if not isinstance(surface, Geom_BSplineSurface):
        converted = cq.Shape.cast(BRepBuilderAPI_NurbsConvert(face.wrapped, True).Shape())
        surface = BRep_Tool.Surface_s(converted.Faces()[0].wrapped)
        u0, u1, t0, t1 = BRepTools.UVBounds_s(converted.Faces()[0].wrapped)
        if not isinstance(surface, Geom_BSplineSurface):
            return None
    return _arrays(name, surface.Copy(), (u0, u1, t0, t1))


def _arrays(name: str, surface: Any, bounds: tuple[float, float, float, float]) -> FacePatch:
    whole = np.array(surface.Bounds())
    round_trip = surface.IsUPeriodic() or surface.IsVPeriodic()
    if surface.IsUPeriodic():
        surface.SetUNotPeriodic()
    if surface.IsVPeriodic():
        surface.SetVNotPeriodic()
    if round_trip or np.abs(whole - bounds).max() > ON_BORDER * np.ptp(whole):
        surface.Segment(*bounds)  # repeats the end knots too
    nu, nt = surface.NbUPoles(), surface.NbVPoles()
    poles = np.empty((nu, nt, 3))
    weights = np.empty((nu, nt))
    for i in range(nu):
        for j in range(nt):
            pole = surface.Pole(i + 1, j + 1)
            poles[i, j] = pole.X(), pole.Y(), pole.Z()
            weights[i, j] = surface.Weight(i + 1, j + 1)
    return FacePatch(
        name, poles, weights, _knots(surface, "U"), _knots(surface, "V"),
        surface.UDegree(), surface.VDegree(),
    )  # fmt: skip


def _knots(surface: Any, way: str) -> Vector:
    """Full knot vector, each knot as often as it counts."""
    count = getattr(surface, f"Nb{way}Knots")()
    knot, times = getattr(surface, f"{way}Knot"), getattr(surface, f"{way}Multiplicity")
    return np.repeat(
        [knot(k) for k in range(1, count + 1)], [times(k) for k in range(1, count + 1)]
    )


def _is_rectangle(face: cq.Face) -> bool:
    """Whether every edge runs along the border of the face's own box of parameters."""
    if len(face.innerWires()):
        return False
    u0, u1, t0, t1 = BRepTools.UVBounds_s(face.wrapped)
    border = np.array([[u0, u1], [t0, t1]])
    slack = ON_BORDER * np.ptp(border, axis=1)
    for edge in face.Edges():
        first, last = BRep_Tool.Range_s(edge.wrapped, face.wrapped)
        curve = BRep_Tool.CurveOnSurface_s(edge.wrapped, face.wrapped, first, last)
        if curve is None:
            return False
        places = [curve.Value(s) for s in np.linspace(first, last, 7).tolist()]
        uv = np.array([[p.X(), p.Y()] for p in places])
        near = np.abs(uv[:, :, None] - border) <= slack[:, None]
        if not near.all(axis=0).any():
            return False
    return True


def _triangles(face: cq.Face) -> tuple[Points, NDArray[np.int64], float]:
    """Triangles that the kernel laid on a face, and how far they are from it."""
    place = TopLoc_Location()
    mesh = BRep_Tool.Triangulation_s(face.wrapped, place)
    if mesh is None:
        raise GeometryError("the CAD kernel lays no triangles on a face; export it as STL instead")
    change = place.Transformation()
    count = range(1, mesh.NbNodes() + 1)
    nodes = [mesh.Node(k).Transformed(change) for k in count]
    points = np.array([[node.X(), node.Y(), node.Z()] for node in nodes])
    uv = np.array([[(at := mesh.UVNode(k)).X(), at.Y()] for k in count])
    corners = np.array(
        [mesh.Triangle(k).Get() for k in range(1, mesh.NbTriangles() + 1)], dtype=np.int64
    ).reshape(-1, 3)
    corners -= 1
    error = _sag(BRep_Tool.Surface_s(face.wrapped), points, uv, corners)
    if face.wrapped.Orientation() == TopAbs_Orientation.TopAbs_REVERSED:
        corners = corners[:, ::-1]
    return points, corners, error


def _sag(surface: Any, points: Points, uv: Array, corners: NDArray[np.int64]) -> float:
    """Largest distance between middles of edges and triangles and the face at the middle there."""
    edges = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    largest = 0.0
    for parts in (np.unique(np.sort(edges), axis=0), corners):
        X, places = points[parts].mean(axis=1), uv[parts].mean(axis=1)
        S = np.array([_at(surface, u, v) for u, v in places.tolist()])
        largest = max(largest, float(np.linalg.norm(X - S, axis=1).max(initial=0.0)))
    return largest


def _at(surface: Any, u: float, v: float) -> tuple[float, float, float]:
    point = surface.Value(u, v)
    return point.X(), point.Y(), point.Z()
