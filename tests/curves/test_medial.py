import numpy as np
import pytest

from bladecad.curves.medial import inscribed, tangents


def ellipse(n: int, a: float, b: float) -> np.ndarray:
    t = 2 * np.pi * np.arange(n) / n
    return np.column_stack([a * np.cos(t), b * np.sin(t)])


def test_every_inscribed_circle_of_a_circle_is_the_circle():
    loop = ellipse(400, 3, 3)
    medial = inscribed(loop, tangents(loop))
    np.testing.assert_allclose(medial.radii, 3, rtol=1e-3)
    np.testing.assert_allclose(medial.centres, 0, atol=1e-2)


def test_the_medial_axis_of_an_ellipse_ends_at_its_centres_of_curvature():
    a, b = 10.0, 2.0
    loop = ellipse(4000, a, b)
    medial = inscribed(loop, tangents(loop))
    end = (a**2 - b**2) / a
    assert np.abs(medial.centres[:, 1]).max() < 5e-3
    assert medial.centres[:, 0].max() == pytest.approx(end, abs=0.02)
    assert medial.centres[:, 0].min() == pytest.approx(-end, abs=0.02)
    assert medial.radii.min() == pytest.approx(b**2 / a, rel=0.02)
    assert medial.radii.max() == pytest.approx(b, rel=1e-3)


def test_a_circle_touches_opposite_points_of_an_ellipse():
    n = 2000
    loop = ellipse(n, 10, 2)
    medial = inscribed(loop, tangents(loop))
    body = np.abs(loop[:, 0]) < 7
    np.testing.assert_allclose(
        loop[medial.partner.astype(int)][body], (loop * [1, -1])[body], atol=0.05
    )


def test_tangents_are_of_second_order_on_uneven_points():
    errors = []
    for n in (200, 400):
        t = 2 * np.pi * np.arange(n) / n
        t = t + 0.3 * np.sin(t)
        loop = np.column_stack([3 * np.cos(t), np.sin(t)])
        exact = np.column_stack([-3 * np.sin(t), np.cos(t)])
        exact /= np.linalg.norm(exact, axis=1)[:, None]
        errors.append(np.abs(tangents(loop) - exact).max())
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.1)
