"""The sparse sums and the blocked solve, against the same problem written out in full."""

from __future__ import annotations

import numpy as np
import pytest

from bladecad.fit.joint import edge_conditions
from bladecad.scans.fitting.freedom import Pair, freedom, local_poles, moved
from bladecad.scans.fitting.kernels import blend
from bladecad.scans.fitting.knots import breaks_along
from bladecad.scans.fitting.laid_on import laid_on
from bladecad.scans.fitting.local import Splines
from bladecad.scans.fitting.normal import accumulate, dense
from bladecad.scans.fitting.solve import best_move
from bladecad.splines import basis
from bladecad.surface.loft import SIDES
from tests.scans.truth import truth_surface

AXIS = np.array([1.0, 0.0, 0.0])


@pytest.fixture(scope="module")
def splined():
    """Rotor 37 in splines, seven stations, coarse."""
    truth = truth_surface("rotor37")
    breaks = breaks_along(truth, 1.2)
    return laid_on(truth, (Splines.on(breaks),) * 2, np.linspace(0.0, 1.0, 7)), breaks


@pytest.fixture(scope="module")
def problem(splined):
    """Places on both sides with weights and distances, and their sums."""
    surface, breaks = splined
    free = freedom(surface, Splines.on(breaks), AXIS)
    rng = np.random.default_rng(5)
    sides = []
    for _ in SIDES:
        u, t = rng.random((2, 2500))
        n = rng.standard_normal((2500, 2))
        M = np.column_stack([n[:, 0] ** 2, n[:, 0] * n[:, 1], n[:, 1] ** 2])
        M += np.array([0.1, 0.0, 0.1])
        sides.append((u, t, M, n * rng.standard_normal((2500, 1))))
    sums = tuple(accumulate(free.in_u, free.in_t, *side) for side in sides)
    return free, sides, sums


def rows(free, u, t):
    """Every product of functions at every place, (k, nu * nt)."""
    return np.einsum("pk,pl->pkl", free.in_u(u), free.in_t(t)).reshape(len(u), -1)


def test_four_functions_are_all_that_live_at_a_place():
    splines = Splines.through(np.linspace(0.0, 1.0, 9))
    x = np.concatenate([[0.0, 1.0], np.random.default_rng(0).random(500), splines.knots])
    first, values = splines.four(x)
    whole = np.zeros((len(x), splines.size))
    for a in range(4):
        whole[np.arange(len(x)), first + a] = values[:, a]
    assert np.abs(whole - basis(splines.knots, 3, x)).max() < 1e-14


def test_a_blend_of_four_by_four_is_that_of_all():
    in_u, in_t = Splines.through(np.linspace(0.0, 1.0, 6)), Splines.on(np.linspace(0.0, 1.0, 8))
    rng = np.random.default_rng(1)
    (u, t), poles = rng.random((2, 300)), rng.standard_normal((in_u.size, in_t.size, 2))
    found = np.zeros((300, 2))
    blend(*in_u.four(u), *in_t.four(t), poles, found)
    whole = np.einsum("pk,pl,kla->pa", in_u(u), in_t(t), poles)
    np.testing.assert_allclose(found, whole, rtol=0.0, atol=1e-13)


def test_sums_are_those_of_the_matrix_written_out(problem):
    free, sides, sums = problem
    shape = (free.in_u.size, free.in_t.size)
    for (u, t, M, f), normal in zip(sides, sums, strict=True):
        J = rows(free, u, t)
        for part in range(3):
            full = ((J * M[:, part, None]).T @ J).reshape(*shape, *shape)
            for dk in range(4):
                blocks = dense(normal, dk, part)
                for k in range(shape[0] - dk):
                    assert np.abs(blocks[k] - full[k, :, k + dk]).max() < 1e-10
        assert np.abs(normal.g.reshape(-1, 2) - J.T @ f).max() < 1e-10


def test_every_way_keeps_the_edges_joined_and_is_told_from_the_others(splined, problem):
    surface, _ = splined
    free = problem[0]
    S, P = surface.suction.bases[0], surface.pressure.bases[0]
    B = edge_conditions(S, P, surface.le, surface.te)
    own = np.vstack(free.own)
    sizes = np.abs(B) @ np.abs(own)
    assert (np.abs(B @ own) < 1e-12 * sizes.max(axis=1, keepdims=True)).all()
    assert free.ways == S.size + P.size - len(B)


def test_the_move_is_the_best_of_all_moves(splined, problem):
    """It solves the normal equations of the dense problem, roughness among the rows."""
    surface, _ = splined
    free, sides, sums = problem
    now = local_poles(surface, free)
    nu, nt, f = free.in_u.size, free.in_t.size, free.ways
    rng = np.random.default_rng(7)
    along_u, along_t = (Pair(*(rng.uniform(0.1, 1.0, n) for _ in SIDES)) for n in (nt, nt - 3))
    y = best_move(free, sums, (along_u, along_t), now)
    Du, Dt = (np.diff(np.eye(n), 3, axis=0) for n in (nu, nt))
    A, b = np.zeros((nu, 2, f, nu, 2, f)), np.zeros((nu, 2, f))
    for T, c, w_u, w_t, (u, t, M, pull) in zip(
        free.local, now, along_u, along_t, sides, strict=True
    ):
        J = np.einsum("pk,pf->pkf", free.in_u(u), free.in_t(t) @ T)
        b += np.einsum("pkf,pa->kaf", J, pull)
        for a, d in np.ndindex(2, 2):
            A[:, a, :, :, d] += np.tensordot(J * M[:, a + d, None, None], J, (0, 0))
        rough_u = np.einsum("qk,lf->qlkf", Du, T)  # of every move, (.., .., nu, f)
        rough_t = np.einsum("mk,ql,lf->mqkf", np.eye(nu), Dt, T)
        for a in range(2):
            for R, w, r in (
                (rough_u, w_u[None, :, None, None], Du @ c[:, :, a]),
                (rough_t, w_t[None, :, None, None], c[:, :, a] @ Dt.T),
            ):
                A[:, a, :, :, a] += np.tensordot(R * w, R, ((0, 1), (0, 1)))
                b[:, a] -= np.tensordot(R * w, r, ((0, 1), (0, 1)))
    left = np.einsum("kafmdg,mdg->kaf", A, y) - b
    assert np.abs(left).max() < 3e-12 * A.max() * np.abs(y).max()  # 1e-12 steadies the solve


def test_a_moved_surface_moves_by_what_was_asked(splined, problem):
    surface, _ = splined
    free = problem[0]
    y = np.random.default_rng(3).standard_normal((free.in_u.size, 2, free.ways))
    u, t = np.linspace(0.0, 1.0, 11), np.linspace(0.0, 1.0, 17)
    after = moved(surface, free, y)
    for name, T in zip(SIDES, free.local, strict=True):
        move = np.einsum("uk,kaf,tf,ax->utx", free.in_u(u), y, free.in_t(t) @ T, free.axes)
        assert np.abs(after(name, u, t) - surface(name, u, t) - move).max() < 1e-9
        assert np.abs((after(name, u, t) - surface(name, u, t)) @ AXIS).max() < 1e-9
