from dataclasses import replace

import numpy as np
import pytest

from bladecad.errors import DataError
from bladecad.passage.trim import Trimmed
from bladecad.passage.walls import walls
from tests.passage.made import HIGH, HUB, LOW, SHROUD, B, line, prism

T = np.linspace(0.0, 1.0, 41)


def trimmed(surface=None, hub=HUB, shroud=SHROUD, **gaps):
    return Trimmed(surface or prism(), 2, *walls(line(hub), line(shroud)), **gaps)


@pytest.mark.parametrize("gap", [0.0, 0.5])
def test_a_prism_is_cut_where_its_points_reach_the_cylinders(gap):
    blade = trimmed(tip_gap=gap)
    low, high = blade.ends("suction", T)
    y = B * np.sin(np.pi * T)
    np.testing.assert_allclose(low, (np.sqrt(HUB**2 - y**2) - LOW) / (HIGH - LOW), atol=1e-12)
    reach = np.sqrt((SHROUD - gap) ** 2 - y**2)
    np.testing.assert_allclose(high, (reach - LOW) / (HIGH - LOW), atol=1e-12)
    assert blade.cut("shroud", "suction", T)[1] < 1e-9


def test_ends_of_the_trimmed_blade_lie_on_the_walls():
    blade = trimmed(hub_gap=0.3)
    for v, r in ((0.0, HUB + 0.3), (1.0, SHROUD)):
        X = blade.at("pressure", np.full_like(T, v), T)
        np.testing.assert_allclose(np.hypot(X[:, 0], X[:, 1]), r, atol=1e-9)


def test_a_blade_that_falls_short_is_continued_within_the_limit():
    short = prism(high=149.0)  # of 57 mm, by 1.8 %
    _, high = trimmed(short).ends("suction", T)
    assert high.min() > 1.0
    with pytest.raises(DataError, match=r"falls short of the shroud .* 0\.43 mm .* 1 %"):
        trimmed(short, limit=0.01).ends("suction", T)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"hub": 170.0, "shroud": 190.0}, "lies beyond the hub"),
        ({"hub": 50.0, "shroud": 60.0}, "falls short of the hub"),
        ({"hub": HUB, "shroud": HUB + 0.1, "tip_gap": 0.2}, "does not cross the passage"),
    ],
)
def test_a_blade_that_does_not_cross_the_passage_is_refused(change, said):
    with pytest.raises(DataError, match=said):
        trimmed(**change).ends("suction", T)


def test_walls_that_end_before_the_blade_are_refused():
    blade = trimmed()
    blade = replace(blade, hub=walls(line(HUB, 8.0), line(SHROUD))[0])
    with pytest.raises(DataError, match="the hub ends at axial position -8 mm"):
        blade.ends("suction", T)
