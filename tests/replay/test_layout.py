import numpy as np
import pytest

from bladecad.replay.layout import blade_length
from bladecad.replay.subject import REGIONS


def test_the_default_blade_has_15_sections_of_71_points_and_is_100_mm_long(results):
    whole = results.subjects["full"]
    assert [side.points.shape for side in whole.sides] == [(15, 71, 3)] * 2
    assert results.length == pytest.approx(100.0, abs=0.2)
    np.testing.assert_allclose(whole.suction.lines.span, np.linspace(0, 1, 15), atol=0.01)


def test_the_sides_of_the_default_blade_meet_at_both_edges(results):
    suction, pressure = (side.points for side in results.subjects["full"].sides)
    np.testing.assert_allclose(suction[:, [0, -1]], pressure[:, [0, -1]], atol=1e-9)


def test_the_core_lies_inside_the_whole_and_has_as_many_points(results):
    core, full = (results.subjects[region].suction for region in ("core", "full"))
    assert len(core.t) == len(full.t)
    assert blade_length(core.points.swapaxes(0, 1)) == pytest.approx(
        0.94 * blade_length(full.points.swapaxes(0, 1)), rel=0.01
    )


@pytest.mark.parametrize("region", REGIONS)
def test_the_points_are_among_the_places_where_fits_are_judged(results, region):
    for side in results.subjects[region].sides:
        np.testing.assert_allclose(side.judged.points[:, ::9], side.points, atol=1e-9)


def test_a_blade_moved_keeps_its_shape(results):
    subject = results.subjects["full"]
    moved = subject.moved(np.array([1.0, 2.0, 3.0])).suction
    expected = subject.suction.points + np.array([1.0, 2.0, 3.0])
    np.testing.assert_allclose(moved.points, expected, atol=1e-12)
