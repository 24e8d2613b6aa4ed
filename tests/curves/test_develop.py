import numpy as np
import pytest

from bladecad.arrays import Points
from bladecad.curves.develop import develop

T = 2 * np.pi * np.arange(200) / 200
LOOP = np.column_stack([10 * np.cos(T), 3 * np.sin(T) + 0.8 * np.cos(2 * T)])


def on_cylinder(flat: Points, radius: float, axis: int = 2) -> Points:
    m, y = flat.T
    rolled = np.column_stack([radius * np.cos(y / radius), radius * np.sin(y / radius), m])
    return np.roll(rolled, axis - 2, axis=1)


def on_cone(flat: Points, half_angle: float) -> Points:
    """Points of a cone, m along its generators and theta about its axis."""
    m, theta = flat[:, 0] + 80, flat[:, 1] / 40
    r = m * np.sin(half_angle)
    return np.column_stack([r * np.cos(theta), r * np.sin(theta), m * np.cos(half_angle)])


def steps(points: Points) -> Points:
    return np.roll(points, -1, axis=0) - points


def angles(points: Points) -> Points:
    d = steps(points)
    d /= np.linalg.norm(d, axis=1)[:, None]
    return np.arccos(np.clip(np.einsum("kd,kd->k", d, np.roll(d, 1, axis=0)), -1, 1))


def test_a_plane_section_keeps_all_distances_in_any_plane():
    rng = np.random.default_rng(3)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    space = np.column_stack([LOOP, 0 * T]) @ turn.T + [100, 20, 5]
    flat = develop(space, 2)
    assert flat.kind == "plane"
    np.testing.assert_allclose(
        np.linalg.norm(flat.points[:, None] - flat.points[None], axis=2),
        np.linalg.norm(LOOP[:, None] - LOOP[None], axis=2),
        atol=1e-9,
    )


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_section_on_a_cylinder_rolls_out_to_itself(axis: int):
    flat = develop(on_cylinder(LOOP, 60, axis), axis)
    assert flat.kind == "revolution"
    np.testing.assert_allclose(flat.points * [1, -1], LOOP - LOOP.mean(axis=0), atol=1e-4)
    np.testing.assert_allclose(flat.scale, 1, atol=1e-12)


def test_a_section_on_a_cone_keeps_its_angles_and_scaled_lengths():
    space = on_cone(LOOP, 0.6)
    flat = develop(space, 2)
    assert flat.kind == "revolution"
    assert flat.scale.max() / flat.scale.min() > 1.2
    scale = 0.5 * (flat.scale + np.roll(flat.scale, -1))
    lengths = np.linalg.norm(steps(flat.points), axis=1) * scale
    np.testing.assert_allclose(lengths, np.linalg.norm(steps(space), axis=1), rtol=2e-3)
    np.testing.assert_allclose(angles(flat.points), angles(space), atol=5e-3)


def test_plane_and_cylinder_are_seen_from_the_same_side():
    flat = [develop(p, 2) for p in (on_cylinder(LOOP, 60), on_cylinder(LOOP, 1e6))]
    assert [f.kind for f in flat] == ["revolution", "plane"]
    np.testing.assert_allclose(flat[1].points, flat[0].points, atol=1e-3)


def test_cylinder_and_disc_are_seen_from_the_same_side():
    """Between them lies a cone that opens ever wider; nothing flips on the way."""
    disc = np.column_stack([(LOOP[:, 0] + 80), LOOP[:, 1], 0 * T])
    flat = [develop(on_cone(LOOP * [1, 0.5], a), 2).points for a in (0.1, 0.8, 1.5)]
    flat.append(develop(disc, 2).points)
    for points in flat:
        assert np.sum(points[:, 0] * LOOP[:, 0]) > 0
        assert np.sum(points[:, 1] * LOOP[:, 1]) < 0


def test_neighbouring_stream_surfaces_are_laid_in_one_sense():
    """A surface that falls a little towards the outlet is not laid the other way round."""
    for slope in (-0.02, 0.0, 0.02):
        r = 60 + slope * LOOP[:, 0]
        theta = LOOP[:, 1] / 60
        space = np.column_stack([r * np.cos(theta), r * np.sin(theta), LOOP[:, 0]])
        flat = develop(space, 2).points
        assert np.sum(flat[:, 0] * LOOP[:, 0]) > 0
