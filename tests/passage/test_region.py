import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bladecad.errors import GeometryError
from bladecad.meshes.quality import quality
from bladecad.passage.region import fill


def area(points, triangles):
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    return 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])


@given(st.integers(30, 200), st.floats(0.0, 0.6), st.integers(2, 5))
def test_a_star_is_filled_up_to_its_border_and_no_further(count, depth, arms):
    a = np.linspace(0.0, 2 * np.pi, count, endpoint=False)
    line = (10.0 * (1.0 + depth * np.cos(arms * a)))[:, None] * np.column_stack(
        [np.cos(a), np.sin(a)]
    )
    inner, triangles = fill(line, largest=lambda p: np.full(len(p), 3.0), growth=1.3)
    points = np.concatenate([line, inner])
    found = area(points, triangles)
    x, y = line.T
    assert found.min() > 0.0
    assert found.sum() == pytest.approx(0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
    assert len(triangles) == 2 * len(inner) + count - 2


def test_triangles_grow_from_a_fine_corner_and_stay_shapely():
    fine = np.concatenate([[0.0], np.cumsum(0.05 * 1.2 ** np.arange(24))])
    side = np.append(fine[fine < 19.0], 20.0)
    even = np.linspace(0.0, 20.0, 8)[1:]
    line = np.concatenate(
        [
            np.column_stack([side, 0 * side]),
            np.column_stack([np.full(7, 20.0), even]),
            np.column_stack([20.0 - even, np.full(7, 20.0)]),
            np.column_stack([0 * side, side])[1:-1][::-1],
        ]
    )
    inner, triangles = fill(line, largest=lambda p: np.full(len(p), 3.0), growth=1.2)
    points = np.column_stack([*np.concatenate([line, inner]).T, np.zeros(len(line) + len(inner))])
    assert quality(points, triangles).smallest_angle > 18.0
    assert len(triangles) < 3000


def test_a_border_that_crosses_itself_is_refused():
    line = np.array([[0, 0], [1, 1], [1, 0], [0, 1]], dtype=float)
    with pytest.raises(GeometryError, match="crosses itself"):
        fill(line, largest=lambda p: np.full(len(p), 1.0), growth=1.2)
