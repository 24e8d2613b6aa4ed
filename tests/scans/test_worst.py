from __future__ import annotations

import numpy as np
import pytest

from bladecad.deviation.nearest.feet import Feet
from bladecad.scans.judging.support import Gap
from bladecad.scans.judging.worst import worst_of_scan
from tests.deviation.scanned import blade, feet_at, strewn

SIGMA = 0.01
GAP = Gap("suction", (0.4, 0.5), (0.3, 0.4), 30.0, np.zeros(3), 0.01)


def scan(*bumps, count=30_000):
    """Feet of noise, and of bumps: (u, t, half width, size)."""
    suction, u, t = strewn(count)
    d = np.random.default_rng(5).normal(0.0, SIGMA, count)
    for at_u, at_t, half, size in bumps:
        d[(abs(u - at_u) < half) & (abs(t - at_t) < half) & suction] += size
    return feet_at(blade(), suction, u, t, d)


def worst(feet: Feet, weight=None, gaps=()):
    weight = np.ones(len(feet.u)) if weight is None else weight
    return worst_of_scan(feet, weight, gaps, SIGMA)


def test_the_worst_place_comes_first_and_no_place_twice():
    found = worst(scan((0.5, 0.5, 0.03, 0.3), (0.2, 0.8, 0.03, 0.2)))
    assert found[0].place.u == pytest.approx(0.5, abs=0.03)
    assert found[1].place.t == pytest.approx(0.8, abs=0.03)
    assert len(found) == 5


def test_noise_is_called_noise():
    assert all(one.why.startswith("noise: ") for one in worst(scan()))


@pytest.mark.parametrize(
    ("u", "t", "why"),
    [
        (0.005, 0.5, "near the hub rim"),
        (0.995, 0.5, "near the tip rim"),
        (0.5, 0.002, "at the leading edge"),
        (0.5, 0.998, "at the trailing edge"),
        (0.45, 0.415, "beside gap 1, where no point holds the surface"),
    ],
)
def test_places_that_are_hard_to_scan_are_named(u: float, t: float, why: str):
    found = worst(scan((u, t, 0.015, 0.2)), gaps=(GAP,))
    assert why in found[0].why


def test_rough_places_are_told_by_their_scatter():
    feet = scan()
    here = feet.suction & (abs(feet.u - 0.5) < 0.1) & (abs(feet.t - 0.5) < 0.1)
    d = np.where(here, 8.0 * feet.distance, feet.distance)
    found = worst(feet_at(blade(), feet.suction, feet.u, feet.t, d))
    assert "the scan is rough here" in found[0].why


def test_lone_outliers_are_no_place_but_a_crowd_is():
    feet = scan((0.5, 0.5, 0.03, 1.0))
    out = feet.distance > 0.5
    alone = np.random.default_rng(1).random(len(out)) < 0.004
    d = np.where(alone & ~out, 9.0, feet.distance)
    feet = feet_at(blade(), feet.suction, feet.u, feet.t, d)
    found = worst(feet, np.where(out | alone, 0.0, 1.0))
    assert abs(found[0].place.deviation) < 1.1
    assert "stand off together and were set aside" in found[0].why
    assert not any("stand off together" in one.why for one in found[1:])


def test_a_point_alone_is_called_so():
    feet = scan()
    k = int(np.argmin((feet.u - 0.5) ** 2 + (feet.t - 0.5) ** 2))
    d = np.array(feet.distance)
    d[k] = 6.0 * SIGMA
    found = worst(feet_at(blade(), feet.suction, feet.u, feet.t, d))
    assert found[0].place.index == k
    assert found[0].why.startswith("alone: ")
