import numpy as np
import pytest

from bladecad.curves.corners import corners, turns
from bladecad.curves.develop import develop
from bladecad.data.synthetic import synthetic_blade


def teardrop(n: int) -> np.ndarray:
    """Round in front, a wedge of 12 degrees behind; counter-clockwise."""
    t = np.linspace(-np.pi, np.pi, n, endpoint=False)
    c = np.cos(t)
    return np.column_stack([10 * c, 0.5 * (1 + c) * np.sin(t) * 1.5])[::1]


def flat_loop(edge: str) -> np.ndarray:
    section = synthetic_blade(1, 100, trailing_edge=edge).sections[0]
    loop = develop(section.points, 2).points
    x, y = loop.T
    return loop * [1, np.sign(np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))]


def test_the_turns_of_a_closed_loop_add_up_to_one_round():
    assert turns(flat_loop("round")).sum() == pytest.approx(2 * np.pi)


def test_round_edges_have_no_corner():
    assert corners(flat_loop("round")) == []


def test_a_cut_off_edge_has_its_two_corners():
    edges = corners(flat_loop("blunt"))
    assert [set(edge) for edge in edges] == [{0, 99}]


def test_a_wedge_is_one_sharp_corner():
    edges = corners(teardrop(120))
    assert edges == [(0,)]


def test_corners_do_not_depend_on_where_the_loop_starts():
    loop = flat_loop("blunt")
    for start in (1, 17, 50):
        (edge,) = corners(np.roll(loop, -start, axis=0))
        assert {(i + start) % 100 for i in edge} == {0, 99}
