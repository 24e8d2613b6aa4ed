from __future__ import annotations

import numpy as np
import pytest

from bladecad.meshes.quality import quality
from bladecad.meshes.strips import zipped


def measured(*corners: tuple[float, float]):
    return quality(np.column_stack([np.array(corners), np.zeros(3)]), np.array([[0, 1, 2]]))


def test_an_equilateral_triangle_is_perfect():
    found = measured((0, 0), (2, 0), (1, 3**0.5))
    assert found.smallest_angle == pytest.approx(60)
    assert found.skewness == pytest.approx(0, abs=1e-12)
    assert found.aspect == pytest.approx(1)
    assert found.area == pytest.approx(3**0.5)
    assert (found.shortest, found.longest) == pytest.approx((2, 2))


def test_a_right_angled_one_has_the_numbers_of_the_book():
    found = measured((0, 0), (1, 0), (0, 1))
    assert found.smallest_angle == pytest.approx(45)
    assert found.skewness == pytest.approx(max(30 / 120, 15 / 60))
    assert found.aspect == pytest.approx(2**0.5 * (2 + 2**0.5) / (4 * 3**0.5 * 0.5))


def test_a_needle_is_bad_and_no_triangle_at_all_is_worst():
    assert measured((0, 0), (1, 0), (1, 1e-3)).smallest_angle == pytest.approx(0.0573, rel=1e-2)
    flat = measured((0, 0), (1, 0), (2, 0))
    assert flat.skewness == pytest.approx(1)
    assert flat.aspect == np.inf


@pytest.mark.parametrize("counts", [(5, 5), (5, 3), (1, 7), (4, 1)])
def test_a_strip_covers_what_lies_between_its_lines(counts: tuple[int, int]):
    a, b = (
        np.column_stack([np.linspace(0, 3, n) if n > 1 else [1.0], np.full(n, y), np.zeros(n)])
        for n, y in zip(counts, (0.0, 1.0), strict=True)
    )
    vertices = np.concatenate([a, b])
    lines = [np.arange(counts[0]), counts[0] + np.arange(counts[1])]
    strip = zipped(vertices, lines)
    assert len(strip) == sum(counts) - 2
    X = vertices[strip]
    area = 0.5 * np.cross(X[:, 1] - X[:, 0], X[:, 2] - X[:, 0])[:, 2]
    assert np.all(area < 0)  # wound one way
    wide = [3.0 if n > 1 else 0.0 for n in counts]
    assert -area.sum() == pytest.approx(0.5 * sum(wide))
