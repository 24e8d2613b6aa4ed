"""The paper's layout, 15 lines of 71 points: how fast its own models are; run by `make bench`."""

import numpy as np
import pytest

from bladecad.fit.flow import evaluate, trajectory_rk4
from bladecad.fit.matching import identify
from bladecad.fit.steps import arc_length_steps

S = np.linspace(0.03, 0.97, 71)
LINES = [
    np.column_stack([55 * S, 20 * S * (1 - S), np.full(71, 5.0 * i)]) + [0, 0, 1] * (S * S)[:, None]
    for i in range(15)
]


@pytest.mark.parametrize("model", ["paper", "affine", "second-order"])
def test_identify_fifteen_lines(benchmark, model):
    fits = benchmark(lambda: [identify(x, arc_length_steps(x), model=model) for x in LINES])
    assert not any(fit.reason for fit in fits)


def test_evaluate_a_thousand_points(benchmark):
    flow = identify(LINES[0], arc_length_steps(LINES[0]), model="second-order").flow
    x = benchmark(evaluate, flow, np.linspace(0, 1, 1000))
    assert x.shape == (1000, 3)


def test_follow_a_line_by_runge_kutta(benchmark):
    fit = identify(LINES[0], arc_length_steps(LINES[0]))
    x = benchmark(trajectory_rk4, fit.flow, fit.t, 4)
    assert x.shape == (71, 3)
