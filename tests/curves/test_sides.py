from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bladecad.curves.sides import fraction_of, parameter_of, split_sides
from bladecad.data.synthetic import profiles, synthetic_blade
from bladecad.errors import DataError
from tests.curves.blades import PUBLISHED, published

RATIOS = st.floats(0.8, 1.2)
T = np.linspace(0, 1, 101)


@given(RATIOS)
def test_parameter_and_fraction_are_inverse(ratio: float):
    np.testing.assert_allclose(fraction_of(parameter_of(T, ratio), ratio), T, atol=1e-9)
    np.testing.assert_allclose(parameter_of(fraction_of(T, ratio), ratio), T, atol=1e-9)


@given(RATIOS)
def test_the_parameter_rises_from_edge_to_edge(ratio: float):
    t = parameter_of(T, ratio)
    assert (t[0], t[-1]) == (0, pytest.approx(1, abs=1e-15))
    assert (np.diff(t) > 0).all()


@given(RATIOS)
def test_both_sides_leave_the_edges_at_the_same_rate(ratio: float):
    """dt/ds = (dt/df) / (ratio Lm) is 1/Lm at both edges, and its derivative vanishes."""
    h = 1e-4
    for f in (np.array([0, h, 2 * h]), np.array([1, 1 - h, 1 - 2 * h])):
        t = parameter_of(f, ratio)
        rate = (-3 * t[0] + 4 * t[1] - t[2]) / (-3 * f[0] + 4 * f[1] - f[2])
        assert rate == pytest.approx(ratio, abs=1e-6)
        assert (t[0] - 2 * t[1] + t[2]) / h**2 == pytest.approx(0, abs=0.01)


def test_the_sides_meet_at_both_edges():
    lines = split_sides(synthetic_blade(4, 80))
    ends = [lines.sample(side, np.array([0.0, 1.0])) for side in ("suction", "pressure")]
    np.testing.assert_allclose(ends[0], ends[1], atol=1e-9)


def test_measured_points_lie_at_their_parameters():
    blade = synthetic_blade(3, 80)
    lines = split_sides(blade)
    for side in ("suction", "pressure"):
        for k, t in enumerate(lines.parameters(side)):
            ratio = lines.sides[side][k].length / lines.lengths[k]
            points = lines.sides[side][k](fraction_of(t, ratio))
            away = np.linalg.norm(points[:, None] - blade.sections[k].points[None], axis=2)
            assert away.min(axis=1).max() < 1e-8
    counts = sum(len(lines.parameters(side)[0]) for side in ("suction", "pressure"))
    assert 80 <= counts <= 82


def test_span_rises_from_hub_to_tip_with_the_sections():
    lines = split_sides(synthetic_blade(6, 60))
    assert (lines.span[0], lines.span[-1]) == (0, 1)
    heights = [profile.height for profile in profiles(6)]
    expected = (np.array(heights) - heights[0]) / (heights[-1] - heights[0])
    np.testing.assert_allclose(lines.span, expected, atol=0.02)


def test_edges_that_differ_along_the_span_are_refused():
    round_edge = synthetic_blade(3, 100, tagged=True)
    blunt = synthetic_blade(3, 100, trailing_edge="blunt", tagged=True)
    mixed = replace(round_edge, sections=(round_edge.sections[0], *blunt.sections[1:]))
    with pytest.raises(DataError, match="tag the corners of a cut-off edge on all sections"):
        split_sides(mixed)


@pytest.mark.parametrize("name", PUBLISHED)
def test_published_blades_have_two_sides_of_like_length(shared_data: Path, name: str):
    blade = published(shared_data, name)
    lines = split_sides(blade)
    assert len(lines.names) == len(blade.sections)
    for suction, pressure in zip(lines.suction, lines.pressure, strict=True):
        assert 0.7 < suction.length / pressure.length < 1.45
