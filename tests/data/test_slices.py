from __future__ import annotations

import numpy as np
import pytest
import trimesh

from bladecad.data.slices import loops_at, span_field, welded
from bladecad.errors import DataError


def bar(*, closed: bool = True, bend: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """A flat elliptic bar along x, thinning and turning, its ends on paraboloids."""
    u, phi = np.linspace(0, 1, 41), np.linspace(0, 2 * np.pi, 96, endpoint=False)
    y = (12 - 3 * u[:, None]) * np.cos(phi)
    z = (1.2 - 0.3 * u[:, None]) * np.sin(phi)
    turn = 0.8 * u[:, None]
    y, z = np.cos(turn) * y - np.sin(turn) * z, np.sin(turn) * y + np.cos(turn) * z
    low, high = bend * y**2, 40 + 0.5 * bend * (y**2 + z**2)
    x = low + u[:, None] * (high - low)
    grid = np.arange(41 * 96).reshape(41, 96)
    a, b = grid[:-1], np.roll(grid, -1, axis=1)[:-1]
    c, d = grid[1:], np.roll(grid, -1, axis=1)[1:]
    quads = [np.stack([a, c, b], -1).reshape(-1, 3), np.stack([b, c, d], -1).reshape(-1, 3)]
    if closed:
        for row in (grid[0], grid[-1]):
            j, k = row[:48], row[48:][::-1]
            quads += [np.stack([j[:-1], j[1:], k[:-1]], -1), np.stack([k[:-1], j[1:], k[1:]], -1)]
    return np.stack([x, y, z], -1).reshape(-1, 3), np.concatenate(quads)


@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize("bend", [0.0, 0.02])
@pytest.mark.parametrize("moved", [True, False])
def test_hub_and_tip_are_found_and_every_level_is_one_loop(closed, bend, moved):
    vertices, triangles = bar(closed=closed, bend=bend)
    if moved:
        T = trimesh.transformations.random_rotation_matrix(np.random.default_rng(3).random(3))
        vertices = vertices @ T[:3, :3].T + [30.0, -200.0, 7.0]
    field = span_field(*welded(vertices, triangles))
    assert field.misfit < 0.005
    w = field(vertices).reshape(41, 96)
    share = np.linspace(0, 1, 41)[:, None]
    off = min(np.abs(w - share).max(), np.abs(1 - w - share).max())
    assert off < 0.006
    levels = np.linspace(0.01, 0.99, 9)
    for level, loops in zip(
        levels, loops_at(vertices, triangles, field(vertices), levels), strict=True
    ):
        assert len(loops) == 1
        np.testing.assert_allclose(field(loops[0]), level, atol=1e-3)
        steps = np.linalg.norm(np.diff(loops[0], axis=0), axis=1)
        assert steps.max() < 2.0
        assert steps.sum() == pytest.approx(4 * 11, rel=0.2)


def test_the_axis_given_is_the_axis_taken():
    field = span_field(*bar(), np.array([-2.0, 0.0, 0.0]))
    np.testing.assert_array_equal(field.axis, [-1.0, 0.0, 0.0])


def test_sides_that_do_not_share_their_edges_still_give_loops():
    vertices, triangles = bar()
    upper = vertices[triangles].mean(axis=1)[:, 2] > 0
    split = np.concatenate(
        [vertices[triangles[upper]] + [0, 0, 0.004], vertices[triangles[~upper]]]
    )
    mesh = welded(split.reshape(-1, 3), np.arange(3 * len(split)).reshape(-1, 3))
    field = span_field(*mesh, np.array([1.0, 0.0, 0.0]))
    for loops in loops_at(*mesh, field(mesh[0]), np.array([0.2, 0.5, 0.8])):
        assert len(loops[0]) > 90
        assert sum(len(loop) for loop in loops[1:]) == 0


def test_what_no_direction_cuts_into_single_slender_loops_is_refused():
    ball = trimesh.creation.icosphere(subdivisions=3)
    with pytest.raises(DataError, match=r"no direction cuts .* give --span-axis"):
        span_field(ball.vertices, np.asarray(ball.faces, np.int64))
