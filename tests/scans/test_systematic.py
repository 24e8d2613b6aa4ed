from __future__ import annotations

import numpy as np
import pytest

from bladecad.scans.judging.systematic import FEWEST, systematic
from tests.deviation.scanned import placed, strewn

SIGMA = 0.03


def found(d, *, count=60_000, weight=None, rim=None, seed=0):
    suction, u, t = strewn(count, seed)
    noise = np.random.default_rng(seed + 1).normal(0.0, SIGMA, count)
    feet = placed(suction, u, t, noise + d(suction, u, t))
    return systematic(feet, np.ones(count) if weight is None else weight(suction, u, t))


@pytest.mark.parametrize("seed", range(5))
def test_noise_alone_is_not_systematic(seed: int):
    """The largest of a thousand means of thirty points is some four standard errors."""
    none = found(lambda *_: 0.0, seed=seed)
    assert none.largest < 2.0 * SIGMA / np.sqrt(FEWEST)
    assert none.share > 0.99


@pytest.mark.parametrize("side", [True, False])
@pytest.mark.parametrize("size", [0.05, -0.05])
def test_a_bump_is_found_with_its_place_and_its_size(side: bool, size: float):
    def bump(suction, u, t):
        return size * ((suction == side) & (abs(u - 0.3) < 0.05) & (abs(t - 0.7) < 0.05))

    worst = found(bump, count=400_000).worst
    assert worst.side == ("suction" if side else "pressure")
    assert worst.u == pytest.approx(0.3, abs=0.05)
    assert worst.t == pytest.approx(0.7, abs=0.05)
    assert worst.mean == pytest.approx(size, abs=0.02)
    assert 0.6 * abs(size) < worst.sure < 1.2 * abs(size)


def test_a_shift_of_everything_is_found_to_its_size():
    assert found(lambda *_: 0.02, count=400_000).largest == pytest.approx(0.02, abs=0.01)


def test_outliers_do_not_count_but_a_crowd_of_them_does():
    def here(suction, u, t):
        return suction & (u < 0.1) & (t > 0.95)

    def far(*place):
        return 5.0 * here(*place)

    one_in_ten = np.random.default_rng(7).random(60_000) < 0.1
    lone = found(lambda *_: 5.0 * one_in_ten, weight=lambda *_: np.where(one_in_ten, 0.0, 1.0))
    assert lone.largest < 0.5 * SIGMA
    crowd = found(far, weight=lambda *place: np.where(here(*place), 0.0, 1.0))
    assert crowd.largest > 4.5


def test_few_points_are_judged_in_large_cells_and_too_few_not_at_all():
    assert found(lambda *_: 0.1, count=20_000).largest == pytest.approx(0.1, abs=0.02)
    assert found(lambda *_: 0.1, count=8_000).largest == pytest.approx(0.1, abs=0.03)
    nothing = found(lambda *_: 0.1, count=40)
    assert nothing.worst is None
    assert nothing.largest == 0.0
    assert nothing.share == 0.0


def test_a_bump_at_an_edge_narrower_than_a_hundredth_is_seen():
    def bump(suction, u, t):
        return 0.3 * (suction & (t < 0.003))

    assert found(bump, count=400_000).worst.t < 0.01
