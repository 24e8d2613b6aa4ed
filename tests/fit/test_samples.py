import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bladecad.curves.sides import split_sides
from bladecad.data.synthetic import synthetic_blade
from bladecad.errors import DataError
from bladecad.fit.samples import DIGITS, FINE, Samples, by_section, densify, shared_parameters

inside = st.lists(st.floats(0.0, 1.0), min_size=1, max_size=40).map(np.sort)


@given(st.lists(inside, min_size=1, max_size=4), st.integers(1, 9))
def test_samples_are_nowhere_sparser_than_asked_in_any_gap_of_any_section(measured, per_gap):
    """Every gap holds its share, but for the cells at its ends in which density is counted."""
    t = shared_parameters(measured, per_gap)
    for own in measured:
        ends = np.unique(np.concatenate([[0.0], own, [1.0]]))
        count = np.searchsorted(t, ends[1:], "right") - np.searchsorted(t, ends[:-1], "left")
        whole_cells = np.floor(np.diff(ends) * FINE) - 1
        share = per_gap * np.maximum(whole_cells, 0) / (np.diff(ends) * FINE)
        assert (count >= np.floor(share)).all()


@given(st.lists(st.integers(3, 300), min_size=1, max_size=3), st.integers(1, 9))
def test_no_step_is_longer_than_the_share_of_an_even_gap(counts, per_gap):
    t = shared_parameters([np.linspace(0, 1, n) for n in counts], per_gap)
    rounding = 10.0**-DIGITS  # half a digit at each end of a step
    assert np.diff(t).max() <= 1.0 / (per_gap * (max(counts) - 1)) + rounding


@given(st.lists(inside, min_size=1, max_size=4), st.integers(1, 9))
def test_samples_rise_from_edge_to_edge(measured, per_gap):
    t = shared_parameters(measured, per_gap)
    assert t[0] == 0.0
    assert t[-1] == 1.0
    assert (np.diff(t) > 0).all()


def test_a_hundred_coinciding_parameters_do_not_ask_for_a_million_samples():
    crowded = np.concatenate([np.full(100, 0.5), np.linspace(0, 1, 11)])
    assert len(shared_parameters([np.sort(crowded)], 4)) < 100


@pytest.mark.parametrize("side", ["suction", "pressure"])
def test_densified_sections_of_different_counts_lie_on_their_lines(side):
    few, many = synthetic_blade(3, 80, tagged=True), synthetic_blade(3, 140, tagged=True)
    mixed = [few.sections[0], many.sections[1], few.sections[2]]
    lines = split_sides(type(few)(tuple(mixed), few.source, few.row))
    samples = densify(lines, side, 4)
    np.testing.assert_array_equal(samples.points, lines.sample(side, samples.t))
    assert samples.points.shape == (3, len(samples.t), 3)
    assert len(samples.t) > 4 * max(len(t) for t in lines.parameters(side)) - 8
    for track, points in zip(lines.sides[side], samples.points, strict=True):
        np.testing.assert_allclose(points[[0, -1]], track(np.array([0.0, 1.0])), atol=1e-9)


def test_columns_about_a_centre_turn_back_into_sections():
    points = np.random.default_rng(0).normal(size=(4, 6, 3))
    samples = Samples(np.linspace(0, 1, 6), points)
    columns = samples.about(samples.centre)
    np.testing.assert_allclose(columns.sum(axis=0).reshape(4, 3).sum(axis=0), 0.0, atol=1e-12)
    np.testing.assert_allclose(by_section(columns) + samples.centre, points, atol=1e-14)


def test_samples_are_checked():
    with pytest.raises(DataError, match="shape"):
        Samples(np.linspace(0, 1, 6), np.zeros((4, 5, 3)))
