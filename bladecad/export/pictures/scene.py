"""The blade in light and shade, rendered off-screen by VTK."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Final

import numpy as np
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401  (the renderer that the others ask for)
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLogger, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals
from vtkmodules.vtkRenderingCore import (
    vtkActor,
    vtkLight,
    vtkPolyDataMapper,
    vtkRenderer,
    vtkRenderWindow,
    vtkWindowToImageFilter,
)

from bladecad.arrays import Array, Lines, Points
from bladecad.export.pictures.view import View
from bladecad.surface.ruled import Triangles
from bladecad.surface.triangulate import BladeMesh

Image = NDArray[np.uint8]

COLOURS: Final = {
    "SUCTION_SIDE": (0.40, 0.62, 0.82),
    "PRESSURE_SIDE": (0.90, 0.58, 0.45),
    "HUB": (0.58, 0.59, 0.62),
    "TIP": (0.80, 0.81, 0.83),
    "LEADING_EDGE": (0.90, 0.76, 0.40),
    "TRAILING_EDGE": (0.52, 0.68, 0.46),
}
INK: Final = (0.10, 0.12, 0.15)
FEATURE = 40.0  # degrees between triangles beyond which an edge is drawn sharp
LINE = 2.4  # pixels, before the picture is halved


def render(mesh: BladeMesh, lines: list[Lines], view: View, pixels_per_mm: float) -> Image:
    """Render a blade with lines drawn on it, (rows, columns, 3), on white."""
    faces = [_face(mesh.vertices, tri, COLOURS[name]) for name, tri in mesh.faces.items()]
    return render_actors([*faces, *map(lines_actor, lines)], view, pixels_per_mm)


def render_actors(actors: Iterable[vtkActor], view: View, pixels_per_mm: float) -> Image:
    """Render what was made to be seen, (rows, columns, 3), on white."""
    renderer = vtkRenderer()
    renderer.SetBackground(1.0, 1.0, 1.0)
    for actor in actors:
        renderer.AddActor(actor)
    _light(renderer, view)
    _aim(renderer, view)
    width, height = (max(round(pixels_per_mm * side), 16) for side in view.size)
    return _image(renderer, width, height)


def _face(vertices: Points, triangles: Triangles, colour: tuple[float, float, float]) -> vtkActor:
    used, ids = np.unique(triangles, return_inverse=True)
    mapper = _mapper(vertices[used], ids.reshape(-1, 3))
    mapper.ScalarVisibilityOff()
    actor = vtkActor()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.SetColor(*colour)
    look.SetAmbient(0.30)
    look.SetDiffuse(0.75)
    look.SetSpecular(0.35)
    look.SetSpecularPower(18.0)
    return actor


def painted_actor(vertices: Points, triangles: Triangles, colours: Array) -> vtkActor:
    """Triangles with a colour each, (m, 3) of 0 to 1, in a light that leaves it as it is."""
    mapper = _mapper(vertices, triangles, colours)
    mapper.SetScalarModeToUseCellData()
    actor = vtkActor()
    actor.SetMapper(mapper)
    look = actor.GetProperty()
    look.SetAmbient(0.62)
    look.SetDiffuse(0.42)
    look.SetSpecular(0.04)
    return actor


def _mapper(
    vertices: Points, triangles: Triangles, colours: Array | None = None
) -> vtkPolyDataMapper:
    data = vtkPolyData()
    data.SetPoints(_points(vertices))
    data.SetPolys(_cells(triangles))
    if colours is not None:
        bytes_ = np.ascontiguousarray(np.rint(255.0 * colours), dtype=np.uint8)
        data.GetCellData().SetScalars(numpy_to_vtk(bytes_, deep=True))
    normals = vtkPolyDataNormals()
    normals.SetInputData(data)
    normals.SetFeatureAngle(FEATURE)
    normals.ConsistencyOff()
    mapper = vtkPolyDataMapper()
    mapper.SetInputConnection(normals.GetOutputPort())
    return mapper


def lines_actor(lines: Lines) -> vtkActor:
    """Lines of equally many points, dark, in front of the faces they lie on."""
    m, k, _ = lines.shape
    data = vtkPolyData()
    data.SetPoints(_points(lines.reshape(-1, 3)))
    data.SetLines(_cells(np.arange(m * k).reshape(m, k)))
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(data)
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    mapper.SetRelativeCoincidentTopologyLineOffsetParameters(-4.0, -4.0)
    actor = vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(*INK)
    actor.GetProperty().SetOpacity(0.75)
    actor.GetProperty().SetLineWidth(LINE)
    actor.GetProperty().LightingOff()
    return actor


def _points(points: Points) -> vtkPoints:
    found = vtkPoints()
    found.SetData(numpy_to_vtk(np.ascontiguousarray(points), deep=True))
    return found


def _cells(ids: NDArray[np.int64]) -> vtkCellArray:
    count, size = ids.shape
    cells = vtkCellArray()
    flat = np.ascontiguousarray(ids, dtype=np.int64).ravel()
    cells.SetData(
        numpy_to_vtkIdTypeArray(np.arange(0, count * size + 1, size, dtype=np.int64), deep=True),
        numpy_to_vtkIdTypeArray(flat, deep=True),
    )
    return cells


def _light(renderer: vtkRenderer, view: View) -> None:
    """A light above the eye, and a weaker one on either hand."""
    renderer.AutomaticLightCreationOff()
    for direction, strength in (
        ((0.0, 0.5, 1.0), 0.75),
        ((-1.2, 0.3, 0.3), 0.4),
        ((1.2, 0.3, 0.3), 0.4),
    ):
        light = vtkLight()
        light.SetLightTypeToSceneLight()
        light.PositionalOff()
        light.SetFocalPoint(*view.centre)
        light.SetPosition(*(view.centre + np.array(direction) @ view.rows))
        light.SetIntensity(strength)
        renderer.AddLight(light)


def _aim(renderer: vtkRenderer, view: View) -> None:
    far = 10.0 * max(view.size)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*view.centre)
    camera.SetPosition(*(view.centre + far * view.rows[2]))
    camera.SetViewUp(*view.rows[1])
    camera.SetParallelScale(0.5 * view.size[1])
    renderer.ResetCameraClippingRange()


def _image(renderer: vtkRenderer, width: int, height: int) -> Image:
    """Render at twice the size and halve, which smooths lines as well."""
    with _quiet():
        window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(2 * width, 2 * height)
    window.AddRenderer(renderer)
    with _quiet():
        window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.ShouldRerenderOff()
    grab.Update()
    pixels = vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars())
    window.Finalize()
    fine = pixels.reshape(height, 2, width, 2, 3)[::-1].astype(np.uint16)
    image = (fine[:, 0, :, 0] + fine[:, 0, :, 1] + fine[:, 1, :, 0] + fine[:, 1, :, 1]) // 4
    return np.asarray(image, dtype=np.uint8)


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep VTK from telling that there is no display; it renders without one."""
    before = vtkLogger.GetCurrentVerbosityCutoff()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    try:
        yield
    finally:
        vtkLogger.SetStderrVerbosity(before)
