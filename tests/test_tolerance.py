"""Bands hold what they say, and tolerances that make no sense are refused."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bladecad.errors import ToleranceError
from bladecad.tolerance import PARAMETERS, ZONES, Band, Tolerances, uniform, unit_of

sizes = st.floats(0.0, 5.0)


@given(sizes, st.floats(1e-6, 5.0), st.floats(-20.0, 20.0))
def test_the_excess_is_the_distance_to_the_band(below, above, d):
    band = Band(-below, above)
    nearest = min(max(d, -below), above)
    assert float(band.excess(d)) == pytest.approx(abs(d - nearest), abs=1e-15)
    assert (d in band) == (float(band.excess(d)) == 0.0)


def test_the_excess_of_what_is_not_measured_is_not_known():
    np.testing.assert_array_equal(Band(-1, 2).excess([3.0, np.nan, -2.0]), [1.0, np.nan, 1.0])


@pytest.mark.parametrize("ends", [(0.1, 0.2), (-0.2, -0.1), (0, 0), (0.1, -0.1), (-np.inf, 1)])
def test_a_band_without_zero_or_width_is_refused(ends):
    with pytest.raises(ToleranceError, match="band"):
        Band(*ends)


def test_uniform_tolerances_hold_every_zone_to_the_same_band():
    tolerances = uniform(0.05)
    assert set(tolerances.zones) == set(ZONES)
    assert set(tolerances.zones.values()) == {Band(-0.05, 0.05)}
    assert tolerances.present == ZONES[:4]
    with pytest.raises(ToleranceError, match="more than 0"):
        uniform(-0.05)


def test_zones_of_the_blade_need_a_band_and_others_do_not():
    band = Band(-0.1, 0.1)
    sides = dict.fromkeys(ZONES[:2], band)
    assert Tolerances(sides, le_zone=0.0, te_zone=0.0).present == ZONES[:2]
    with pytest.raises(ToleranceError, match="leading edge and the trailing edge"):
        Tolerances(sides)
    with pytest.raises(ToleranceError, match="tip margin"):
        Tolerances(dict.fromkeys(ZONES[:5], band), tip_margin=0.1)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"zones": {"fillet": Band(-1, 1)}}, 'unknown zone "fillet"'),
        ({"parameters": {"girth": Band(-1, 1)}}, 'unknown parameter "girth"'),
        ({"coverage": {"leading edge": 1.2}}, "coverage of the leading edge = 1.2"),
        ({"le_zone": 0.3}, "le_zone = 0.3"),
        ({"hub_margin": -0.1}, "hub_margin = -0.1"),
        ({"te_offsets": (0.5, 0.0)}, "te_offsets = 0"),
        ({"allowed_out": 2.0}, "allowed_out = 2"),
    ],
)
def test_what_makes_no_sense_is_named(change, said):
    with pytest.raises(ToleranceError, match=said):
        Tolerances(**({"zones": uniform(0.1).zones} | change))


def test_angles_are_in_degrees_and_all_else_in_mm():
    assert {name for name in PARAMETERS if unit_of(name) == "deg"} == {"stagger", "twist"}
