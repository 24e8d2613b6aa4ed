"""Slabs cut all at once are those cut one by one."""

import numpy as np

from bladecad.scans.finding.slabs import FEWEST, slabs

BORDERS = np.linspace(0.0, 10.0, 6)
VALUES = ("count", "chord", "thick", "miss", "centre", "edges", "quality")


def _lens(count: int, rng: np.random.Generator) -> np.ndarray:
    """Points on a twisted, cambered lens of chord 20 and mean thickness 2."""
    z, turn = rng.uniform(0.0, 10.0, count), rng.uniform(0.0, 2.0 * np.pi, count)
    x, y = 10.0 * np.cos(turn), 1.27 * np.sin(turn) + 0.5 * np.cos(turn) ** 2
    c, s = np.cos(0.02 * z), np.sin(0.02 * z)
    return np.column_stack([c * x - s * y, s * x + c * y, z])


def test_neighbours_do_not_change_what_a_slab_looks_like():
    rng = np.random.default_rng(1)
    flat = np.vstack([_lens(4_000, rng), rng.uniform(-10.0, 10.0, (900, 3))])
    thinned = flat[:, 2] // 2.0 != 3.0
    thinned[np.flatnonzero(~thinned)[: FEWEST - 1]] = True
    flat = flat[thinned]
    together = slabs(flat, BORDERS)
    for k in range(5):
        own = flat[(flat[:, 2] >= BORDERS[k]) & (flat[:, 2] < BORDERS[k + 1])]
        alone = slabs(own, BORDERS)
        for name in VALUES:
            np.testing.assert_allclose(
                getattr(together, name)[k], getattr(alone, name)[k], rtol=1e-9, atol=1e-9
            )


def test_a_lens_is_a_section_and_points_at_random_are_none():
    rng = np.random.default_rng(2)
    found = slabs(_lens(4_000, rng), BORDERS)
    assert found.quality.min() > 0.9
    np.testing.assert_allclose(found.chord, 20.0, rtol=0.01)
    np.testing.assert_allclose(found.thick, 2.0, rtol=0.02)
    np.testing.assert_allclose(found.centre, [[0.0, 0.12]] * 5, atol=0.1)
    assert slabs(rng.uniform(-10.0, 10.0, (4_000, 3)), BORDERS).quality.max() == 0.0


def test_points_of_one_place_are_no_section_and_no_error():
    flat = np.column_stack([np.ones((200, 2)), np.linspace(0.1, 9.9, 200)])
    assert slabs(flat, BORDERS).quality.max() == 0.0
