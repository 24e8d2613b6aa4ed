from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import gmsh
import numpy as np
import pytest

from bladecad.export.cad.step import write_step
from bladecad.meshes.curvature import largest_curvature
from tests.export.products import small

TRIANGLE, TETRAHEDRON = 2, 4


@pytest.fixture
def mesher() -> Iterator[None]:
    gmsh.initialize(interruptible=False)
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.logger.start()
    yield
    gmsh.logger.stop()
    gmsh.finalize()


def edge_radius() -> float:
    """Least radius of the leading edge over the span, mm."""
    u = np.linspace(0.0, 1.0, 41)
    return 1.0 / float(np.abs(largest_curvature(small().surface, "suction", u, 0.0 * u)).max())


def size_along(curves: list[int], size: float) -> None:
    """Elements of that size on some curves, growing away from them."""
    field = gmsh.model.mesh.field
    distance, threshold = field.add("Distance"), field.add("Threshold")
    field.setNumbers(distance, "CurvesList", curves)
    field.setNumber(distance, "Sampling", 400)
    for name, value in (("InField", distance), ("SizeMin", size), ("SizeMax", 4.0),
                        ("DistMin", size), ("DistMax", 15.0)):  # fmt: skip
        field.setNumber(threshold, name, value)
    field.setAsBackgroundMesh(threshold)
    for option in ("ExtendFromBoundary", "FromPoints", "FromCurvature"):
        gmsh.option.setNumber(f"Mesh.MeshSize{option}", 0)


def edges() -> list[int]:
    """The curves that run along the span: leading and trailing edge."""
    found = []
    for _, tag in gmsh.model.getEntities(1):
        low, high = np.reshape(gmsh.model.getBoundingBox(1, tag), (2, 3))
        ends = np.ptp(small().mesh.vertices, axis=0)
        if (high - low)[np.argmax(ends)] > 0.8 * ends.max():
            found.append(tag)
    return found


def test_the_step_is_meshed_at_the_size_of_its_edge_with_no_invalid_element(
    tmp_path: Path, mesher: None
):
    write_step(small().solid, tmp_path / "blade.step", name="blade")
    gmsh.option.setString("Geometry.OCCTargetUnit", "MM")
    gmsh.open(str(tmp_path / "blade.step"))
    assert len(edges()) == 2
    radius = edge_radius()
    size_along(edges(), radius)
    gmsh.model.mesh.generate(3)
    assert not [line for line in gmsh.logger.get() if line.startswith(("Warning", "Error"))]
    for element in (TRIANGLE, TETRAHEDRON):
        tags, nodes = gmsh.model.mesh.getElementsByType(element)
        assert len(tags) > 1000
        assert gmsh.model.mesh.getElementQualities(tags, "minSICN").min() > 0.0
    tags, nodes = gmsh.model.mesh.getElementsByType(1)
    numbers, points, _ = gmsh.model.mesh.getNodes()
    place = np.zeros((int(numbers.max()) + 1, 3))
    place[numbers] = points.reshape(-1, 3)
    a, b = place[nodes.reshape(-1, 2).T]
    assert np.linalg.norm(b - a, axis=1).min() < radius
