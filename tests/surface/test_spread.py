"""Points stand close where a line is curved, and the spline through them is measured."""

from __future__ import annotations

import numpy as np
import pytest

from bladecad.surface.spread import spread, strayed


def test_points_on_a_straight_line_and_on_a_circle_stand_evenly():
    t = np.linspace(0, 1, 500) ** 2
    line = np.column_stack([t, 2 * t, -t]) * 30
    np.testing.assert_allclose(spread(line, t, 10), np.linspace(0, 1, 11), atol=2e-3)
    circle = np.column_stack([np.cos(t), np.sin(t), 0 * t])
    np.testing.assert_allclose(spread(circle, t, 10), np.linspace(0, 1, 11), atol=2e-3)


def test_half_of_the_points_go_to_the_ends_of_a_slender_ellipse():
    phi = np.linspace(0, np.pi, 4001)
    line = np.column_stack([-30 * np.cos(phi), 1.5 * np.sin(phi), 0 * phi])
    chosen = np.interp(spread(line, phi, 60), phi, line[:, 0])
    ends = np.abs(chosen) > 28.5  # a twentieth of the chord
    assert 0.3 < ends.mean() < 0.7


@pytest.mark.parametrize("n", [24, 48])
def test_the_spline_through_points_of_a_circle_strays_by_its_known_error(n: int):
    """Cubic splines miss f by h^4 |f''''| / 384 between even points; radially, h^4 / (384 r^3)."""
    r, h = 7.0, 2 * np.pi / n
    phi = np.arange(n) * h

    def on(angle):
        return r * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])

    away = strayed(on(phi), on(phi + h / 2), closed=True)
    assert away == pytest.approx(r * h**4 / 384, rel=0.1)
