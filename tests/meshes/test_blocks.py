from __future__ import annotations

import numpy as np
import pytest

from bladecad.errors import GeometryError
from bladecad.meshes.blocks import blade_blocks, triangles_of
from bladecad.meshes.curvature import largest_curvature
from bladecad.meshes.sizing import Sizing
from bladecad.surface.blade import principal_curvatures
from tests.cam.blades import tube
from tests.meshes.blades import blade
from tests.passage.made import prism

ASKED = Sizing(3.0, 0.02)


@pytest.mark.parametrize("kind", ["round", "blunt"])
def test_blocks_meet_bit_by_bit_and_are_closed(kind: str):
    found = blade_blocks(blade(kind), ASKED)
    assert found.chord_error <= ASKED.chord_error
    assert found.growth <= 1.2 * 1.001
    by_name = {block.name: block.points for block in found.blocks}
    assert ("blade_te" in by_name) == (kind == "blunt")
    S, P = by_name["blade_suction"], by_name["blade_pressure"]
    assert np.array_equal(by_name["blade_hub"][[0, -1]], [S[0], P[0]])
    assert np.array_equal(by_name["blade_tip"][[0, -1]], [S[-1], P[-1]])
    assert np.array_equal(S[:, 0], P[:, 0])
    mesh = triangles_of(found.blocks)
    assert mesh.open_edges == 0
    assert mesh.volume > 0


def test_u_t_and_curvature_are_those_of_the_surface():
    surface = blade()
    block = blade_blocks(surface, ASKED).blocks[1]
    u, t = block.u[:, 0], block.t[0]
    np.testing.assert_allclose(block.points[:, 1:-1], surface("pressure", u, t)[:, 1:-1], atol=1e-9)
    larger, smaller = principal_curvatures(surface, "pressure", u, t)
    expected = np.where(np.abs(larger) > np.abs(smaller), larger, smaller)
    np.testing.assert_allclose(block.curvature, expected, rtol=1e-6, atol=1e-9)


def test_the_curvature_of_a_tube_is_that_of_its_circle():
    u, t = np.linspace(0, 1, 7), np.linspace(0, 1, 7)
    np.testing.assert_allclose(largest_curvature(tube(), "suction", u, t), 0.1, rtol=1e-9)


def test_too_many_points_are_refused():
    with pytest.raises(GeometryError, match="points a side; ask for a larger one"):
        blade_blocks(blade(), Sizing(0.01, 0.02))


@pytest.mark.parametrize("size", [0.6, 0.65, 0.8, 0.95])
def test_hub_and_tip_end_in_equal_points_at_round_edges(size: float):
    for block in blade_blocks(prism(), Sizing(size, 0.05)).blocks:
        if block.name in ("blade_hub", "blade_tip"):
            X = block.points
            assert np.array_equal(X[:, 0], np.broadcast_to(X[0, 0], X[:, 0].shape))
            assert np.array_equal(X[:, -1], np.broadcast_to(X[0, -1], X[:, -1].shape))
