import numpy as np
import pytest

from bladecad.curves.line import Line


def circle(n: int, radius: float = 5.0) -> Line:
    a = 2 * np.pi * np.arange(n) / n
    return Line(radius * np.column_stack([np.cos(a), np.sin(a), 0 * a]), closed=True)


def helix(n: int) -> tuple[Line, float]:
    a = np.linspace(0, 3, n) ** 1.3
    points = np.column_stack([4 * np.cos(a), 4 * np.sin(a), 3 * a])
    return Line(points, closed=False), float(5 * a[-1])


def test_the_length_of_a_circle_converges_with_order_four():
    errors = [abs(circle(n).length - 10 * np.pi) for n in (20, 40, 80)]
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    assert errors[-1] < 1e-5
    np.testing.assert_allclose(orders, 4, atol=0.2)


def test_the_length_of_a_helix_is_its_closed_form():
    line, length = helix(200)
    assert line.length == pytest.approx(length, rel=1e-7)


@pytest.mark.parametrize("closed", [True, False])
def test_the_points_lie_at_their_stations(closed: bool):
    line = circle(30) if closed else helix(30)[0]
    places = line.stations[:-1] if closed else line.stations
    np.testing.assert_allclose(line(places), line.points, atol=1e-10)


def test_equal_steps_of_arc_length_are_equal_on_the_line():
    line, _ = helix(60)
    s = np.linspace(0, line.length, 2001)
    steps = np.linalg.norm(np.diff(line(s), axis=0), axis=1)
    np.testing.assert_allclose(steps, line.length / 2000, rtol=1e-6)


def test_tangent_and_curvature_of_a_circle_are_exact_to_the_spline():
    line = circle(120)
    s = np.linspace(0, line.length, 77)
    x, tangent, curvature = (line(s, order) for order in (0, 1, 2))
    np.testing.assert_allclose(np.linalg.norm(tangent, axis=1), 1, atol=1e-12)
    np.testing.assert_allclose(np.einsum("kd,kd->k", tangent, curvature), 0, atol=1e-12)
    np.testing.assert_allclose(curvature, -x / 25, atol=2e-4)


def test_a_closed_line_goes_on_round_and_round():
    line = circle(40)
    s = np.array([1.0, 3.0, 30.0])
    np.testing.assert_allclose(line(s), line(s + line.length), atol=1e-9)
    np.testing.assert_allclose(line(s), line(s - 2 * line.length), atol=1e-9)


def test_densified_places_keep_the_points_and_divide_the_gaps():
    line, _ = helix(9)
    dense = line.densified(4)
    np.testing.assert_allclose(dense[::4], line.stations)
    np.testing.assert_allclose(np.diff(dense), np.repeat(np.diff(line.stations) / 4, 4))
