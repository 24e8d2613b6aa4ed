import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import block_diag

from bladecad.fit.joint import JOINED, edge_conditions, solve_joint
from bladecad.fit.samples import Samples
from bladecad.fit.spectrum import Spectrum

T = 0.5 - 0.5 * np.cos(np.pi * np.linspace(0, 1, 160))
SUCTION = Spectrum(5, np.array([[35.0, 1.5]]), np.array([[60.0, -0.3]]))
PRESSURE = Spectrum(5, np.array([[50.0, 0.5]]), np.array([[40.0, 0.8]]))
ENDS = np.array([0.0, 1.0])
KINDS = ("round", "sharp", "blunt")


def sides(sections=3, shift=(100.0, -30.0, 250.0)):
    """Two sides that nearly meet: the halves of ellipses, bent, with a gap of 0.1 mm."""
    theta, u = np.pi * T, np.linspace(0, 1, sections)[:, None]
    x = -25 * np.cos(theta) * np.ones_like(u)
    bow = 3 * np.sin(theta) ** 2 * (1 + u)
    halves = [
        np.stack([x, s * (2 + 0.5 * u) * np.sin(theta) + bow + 0.05 * s, 40 * u + 0 * x], axis=2)
        for s in (1.0, -1.0)
    ]
    return tuple(Samples(T, h + np.array(shift)) for h in halves)


SAMPLES = sides()


def solved(le, te, samples=SAMPLES, **options):
    return solve_joint((SUCTION, PRESSURE), samples, le, te, **options)


def at_ends(spectrum, C, order):
    return np.einsum("tn,mnx->mtx", spectrum(ENDS, order), C)


def kkt(samples, le, te):
    """The same problem by Lagrange multipliers, columns scaled alike, all in one matrix."""
    Phi = block_diag(SUCTION(T), PRESSURE(T))
    centre = 0.5 * (samples[0].centre + samples[1].centre)
    Y = np.concatenate([s.about(centre) for s in samples])
    scale = 1.0 / np.linalg.norm(Phi, axis=0)
    Phi, B = Phi * scale, edge_conditions(SUCTION, PRESSURE, le, te) * scale
    B = B / np.linalg.norm(B, axis=1, keepdims=True) if len(B) else B
    q = len(B)
    K = np.block([[Phi.T @ Phi, B.T], [B, np.zeros((q, q))]])
    C = np.linalg.solve(K, np.concatenate([Phi.T @ Y, np.zeros((q, Y.shape[1]))]))[: len(scale)]
    return Phi @ C, Y


@pytest.mark.parametrize("le", KINDS)
@pytest.mark.parametrize("te", KINDS)
def test_sides_meet_as_the_kind_of_each_edge_says_and_no_further(le, te):
    fit = solved(le, te)
    for end, kind in enumerate((le, te)):
        for order in range(3):
            S, P = at_ends(SUCTION, fit.suction, order), at_ends(PRESSURE, fit.pressure, order)
            apart = np.abs(S - (-1.0) ** order * P)[:, end].max() / np.abs(S[:, end]).max()
            assert (apart < 1e-11) == (order < JOINED[kind])


@pytest.mark.parametrize("le", KINDS)
@pytest.mark.parametrize("te", KINDS)
def test_the_constrained_fit_is_the_minimiser_that_lagrange_multipliers_find(le, te):
    fit = solved(le, te)
    centre = 0.5 * (SAMPLES[0].centre + SAMPLES[1].centre)
    curves = np.concatenate(
        [
            np.einsum("tn,mnx->tmx", s(T), C).reshape(len(T), -1)
            for s, C in ((SUCTION, fit.suction), (PRESSURE, fit.pressure))
        ]
    ) - np.tile(centre, 3)
    expected, Y = kkt(SAMPLES, le, te)
    np.testing.assert_allclose(curves, expected, atol=1e-7)
    assert np.sum((curves - Y) ** 2) <= np.sum((expected - Y) ** 2) * (1 + 1e-9)


@settings(max_examples=20)
@given(st.integers(0, 2**32 - 1))
def test_no_step_that_keeps_the_conditions_comes_closer(seed):
    fit = solved("round", "round")
    B = edge_conditions(SUCTION, PRESSURE, "round", "round")
    rng = np.random.default_rng(seed)
    C = np.concatenate([fit.suction, fit.pressure], axis=1)
    step = rng.normal(size=C.shape) * np.abs(C).mean() * 10.0 ** rng.uniform(-6, -1)
    step -= np.einsum("nq,qk,mkx->mnx", np.linalg.pinv(B), B, step)

    def rss(C):
        return sum(
            np.sum((np.einsum("tn,mnx->mtx", s(T), part) - samples.points) ** 2)
            for s, part, samples in (
                (SUCTION, C[:, : SUCTION.size], SAMPLES[0]),
                (PRESSURE, C[:, SUCTION.size :], SAMPLES[1]),
            )
        )

    assert rss(C + step) >= rss(C)


def test_conditions_count_three_a_round_edge_one_a_sharp_and_none_a_blunt():
    for le in KINDS:
        for te in KINDS:
            B = edge_conditions(SUCTION, PRESSURE, le, te)
            assert B.shape == (JOINED[le] + JOINED[te], SUCTION.size + PRESSURE.size)
            assert np.linalg.matrix_rank(B) == len(B)


def test_without_conditions_each_side_is_fitted_by_itself():
    fit = solved("blunt", "blunt")
    for spectrum, samples, C in zip(
        (SUCTION, PRESSURE), SAMPLES, (fit.suction, fit.pressure), strict=True
    ):
        columns = samples.about(samples.centre)
        alone = np.linalg.lstsq(spectrum(T), columns, rcond=None)[0]
        mine = np.einsum("tn,mnx->tmx", spectrum(T), C).reshape(len(T), -1)
        np.testing.assert_allclose(
            mine - np.tile(samples.centre, 3), spectrum(T) @ alone, atol=1e-8
        )


def test_moving_the_points_moves_the_fit():
    far = sides(shift=(100.0 + 3e4, -30.0 - 5e4, 250.0))
    near, moved = solved("round", "round"), solved("round", "round", far)
    for spectrum, a, b in (
        (SUCTION, near.suction, moved.suction),
        (PRESSURE, near.pressure, moved.pressure),
    ):
        at = [np.einsum("tn,mnx->mtx", spectrum(T), C) for C in (a, b)]
        np.testing.assert_allclose(at[1], at[0] + [3e4, -5e4, 0.0], atol=1e-9)


def test_sections_do_not_feel_one_another():
    whole = solved("round", "round")
    one = tuple(Samples(T, s.points[1:2]) for s in SAMPLES)
    alone = solved("round", "round", one)
    curve = [np.einsum("tn,nx->tx", SUCTION(T), C) for C in (whole.suction[1], alone.suction[0])]
    np.testing.assert_allclose(curve[0], curve[1], atol=1e-9)


def test_equal_weights_change_nothing_and_heavy_ones_pull():
    plain = solved("round", "round")
    even = solved("round", "round", weights=(np.full(len(T), 7.0), np.full(len(T), 7.0)))
    np.testing.assert_allclose(even.suction, plain.suction, rtol=1e-6, atol=1e-6)
    heavy = np.where(np.abs(T - 0.01) < 0.01, 1e4, 1.0)
    pulled = solved("round", "round", weights=(heavy, np.ones(len(T))))
    near = heavy > 1
    away = [
        np.linalg.norm(np.einsum("tn,mnx->mtx", SUCTION(T), C) - SAMPLES[0].points, axis=2)[
            :, near
        ].mean()
        for C in (plain.suction, pulled.suction)
    ]
    assert away[1] < 0.5 * away[0]


def test_directions_that_the_data_cannot_tell_apart_are_counted():
    twins = Spectrum(3, np.array([[30.0, 0.5], [30.0, 0.5]]), np.empty((0, 2)))
    fit = solve_joint((twins, PRESSURE), SAMPLES, "round", "round")
    assert fit.free == twins.size + PRESSURE.size - 6
    assert fit.rank == fit.free - 2
    whole = solved("round", "round")
    assert whole.rank == whole.free == SUCTION.size + PRESSURE.size - 6
    assert 1 < whole.condition < 1e11
    assert np.isfinite(fit.suction).all()
    assert np.abs(fit.suction).max() < 1e5
