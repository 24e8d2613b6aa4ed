from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from bladecad.cfd.features import features, write_emesh
from bladecad.cfd.inside import a_place_inside, winding
from bladecad.meshes.blade import mesh_blade
from bladecad.meshes.named import NamedMesh
from bladecad.meshes.sizing import Sizing
from tests.meshes.blades import blade

CORNERS = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
QUADS = {"low": (0, 2, 3, 1), "high": (4, 5, 7, 6), "front": (0, 1, 5, 4), "back": (2, 6, 7, 3),
         "left": (0, 4, 6, 2), "right": (1, 3, 7, 5)}  # fmt: skip


def cube(*, named: bool) -> NamedMesh:
    halves = {name: np.array([[a, b, c], [a, c, d]]) for name, (a, b, c, d) in QUADS.items()}
    patches = halves if named else {"cube": np.concatenate(list(halves.values()))}
    return NamedMesh(CORNERS, patches)


@pytest.mark.parametrize("named", [False, True])
def test_a_cube_has_twelve_edges(named: bool):
    found = features(cube(named=named))
    assert len(found.edges) == 12
    ends = found.points[found.edges]
    np.testing.assert_allclose(np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1), 1.0)
    assert found.between.all() == named
    assert found.between.any() == named


def test_an_edge_that_ends_is_a_feature_and_a_flat_one_is_not():
    square = NamedMesh(CORNERS, {"low": np.array([[0, 2, 3], [0, 3, 1]])})
    assert len(features(square).edges) == 4
    bent = CORNERS.copy()
    bent[3] = [1.0, 1.0, 0.45]
    assert len(features(NamedMesh(bent, square.patches), sharp=60.0).edges) == 4
    assert len(features(NamedMesh(bent, square.patches), sharp=20.0).edges) == 5


def test_of_a_round_blade_they_are_the_lines_between_patches():
    """No triangle of an edge turns so far from its neighbour that it looks sharp."""
    found = features(mesh_blade(blade(), Sizing(4.0, 0.1)).mesh)
    assert found.between.all()


def test_the_emesh_holds_points_in_metres_and_edges(tmp_path: Path):
    found = features(cube(named=True))
    write_emesh(found, tmp_path / "cube.eMesh")
    text = (tmp_path / "cube.eMesh").read_text("ascii")
    assert "class       featureEdgeMesh;" in text
    points, edges = re.findall(r"\n(\d+)\n\(\n(.*?)\n\)", text, re.DOTALL)
    assert (points[0], edges[0]) == ("8", "12")
    read = np.array([row.strip("()").split() for row in points[1].splitlines()], float)
    np.testing.assert_allclose(1e3 * read, found.points)
    assert len(edges[1].splitlines()) == 12


def test_inside_is_inside():
    box = cube(named=True)
    assert winding(box, np.array([0.3, 0.6, 0.2])) == pytest.approx(1)
    assert winding(box, np.array([1.3, 0.6, 0.2])) == pytest.approx(0, abs=1e-12)
    place = a_place_inside(box, 0.1, "right")
    assert place[0] == pytest.approx(0.9)
    assert winding(box, place) == pytest.approx(1)


def test_the_edges_alone_are_the_lines_round_their_zones():
    mesh = mesh_blade(blade(), Sizing(4.0, 0.1)).mesh
    every, edges = features(mesh), features(mesh, only=("blade_le",))
    known = {tuple(sorted(map(tuple, pair))) for pair in every.points[every.edges].tolist()}
    some = {tuple(sorted(map(tuple, pair))) for pair in edges.points[edges.edges].tolist()}
    assert some < known
    on_edge = {tuple(x) for x in mesh.vertices[np.unique(mesh.patches["blade_le"])].tolist()}
    assert all(a in on_edge and b in on_edge for a, b in some)
