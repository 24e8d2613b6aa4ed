"""The paper's second-order form, X'' = A1 X' + A2 X + f, with end conditions that hold exactly.

A1 and A2 come from matching derivatives; with them given, the curve is linear in all the rest:
position, slope and force at t = 0. These are the start of the flow z' = A z with

    z = (y, y', f, 1)        y'' = A1 y' + A2 y + f,   f' = 0,      x = scale y + centre

Positions at both ends are 6 conditions on these 9 numbers. Where slopes are prescribed as well,
the force is a parabola in t, z = (y, y', f, f', f'', 1): 12 conditions on 15. With A1 = A2 = 0 the
curve is a polynomial, the cubic Hermite segment among them; else it is bent by the data's field.

Half the modes of such a field grow, by exp(37) on the core of a real blade and by exp(300) on a
whole side, and a start at t = 0 cannot aim at the other end through them. They are split off
(exponential dichotomy) and started from t = 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from scipy.linalg import block_diag, cdf2rdf, schur, solve_sylvester

from bladecad.arrays import Array, Points, Vector, seal
from bladecad.fit.flow import Flow, evaluate, response

CALM = 5.0  # modes that grow by no more than exp(5), 150 times, start at t = 0 like the rest
FAST = 600.0  # modes that grow by more than exp(600) would leave the floats: they are not excited


@final
@dataclass(frozen=True, eq=False)
class Ends:
    """What a curve must meet at its two ends; None leaves it free.

    start, end             : (3,) float, mm, x at the first and at the last point
    start_slope, end_slope : (3,) float, mm, dx/dt there, with t from 0 to 1
    """

    start: Vector | None = None
    end: Vector | None = None
    start_slope: Vector | None = None
    end_slope: Vector | None = None

    def __post_init__(self) -> None:
        seal(self, **{name: (3,) for name, value in vars(self).items() if value is not None})

    def conditions(self, last: float) -> list[tuple[float, int, Vector]]:
        """List the conditions as (t, order of the derivative, value)."""
        asked = (
            (0.0, 0, self.start),
            (last, 0, self.end),
            (0.0, 1, self.start_slope),
            (last, 1, self.end_slope),
        )
        return [(t, order, value) for t, order, value in asked if value is not None]


def second_order_flow(
    A1: Array, A2: Array, output: tuple[float, Vector], points: Points, t: Vector, ends: Ends
) -> Flow:
    """Find the start and the force that best follow the points and meet the ends.

    Minimises sum_n |x(t_n) - X_n|^2 over (y, y', f) at t = 0, subject to the end conditions,
    by the null-space method; the minimum-norm solution where the points leave something open.

    Parameters
    ----------
    A1, A2 : (3, 3) float
    output : float and (3,) float, mm
        Scale and centre: x = scale y + centre.
    points : (k, 3) float, mm
    t : (k,) float
        Their parameters, from 0.
    ends : Ends
    """
    sloped = ends.start_slope is not None or ends.end_slope is not None
    last = float(t[-1])
    A, S, sizes = _dichotomy(_field(A1, A2, forces=3 if sloped else 1), last)
    scale, centre = output
    C = np.column_stack([scale * S[:3], centre])
    G, g = _rows(response(A, C, t) * sizes, points)
    asked = ends.conditions(last)
    maps = [response(A, C, np.array([at]), order) * sizes for at, order, _ in asked]
    K, k = _rows(np.reshape(maps, (-1, 3, len(A))), np.reshape([v for *_, v in asked], (-1, 3)))
    return Flow(A, C, sizes * np.append(_constrained_lstsq(G, g, K, k), 1.0))


def missed(flow: Flow, ends: Ends, last: float) -> float:
    """Return the largest component, mm, by which the flow misses its end conditions."""
    gaps = [evaluate(flow, np.array([t]), r)[0] - value for t, r, value in ends.conditions(last)]
    return float(np.max(np.abs(gaps), initial=0.0))


def _field(A1: Array, A2: Array, *, forces: int) -> Array:
    A = np.zeros((3 * forces + 6,) * 2)
    A[:-3, 3:] = np.eye(3 * forces + 3)  # y is moved by y', y' by f, f by f'
    A[3:6, 0:3], A[3:6, 3:6] = A2, A1
    return A


def _dichotomy(field: Array, last: float) -> tuple[Array, Array, Vector]:
    """Part what grows from what does not: field S = S diag(calm, growing).

    Returns A = diag(calm, growing, 0), its last state the constant 1, with a block a mode in
    growing; S; and the size exp(-rate last) at t = 0 of what has size 1 at its own end.
    """
    T, V, m = schur(field, output="real", sort=lambda re, im: re * last <= FAST)
    T, Q, n = schur(T[:m, :m], output="real", sort=lambda re, im: re * last <= CALM)
    calm, growing = T[:n, :n], T[n:, n:]
    Q[:, n:] += Q[:, :n] @ solve_sylvester(calm, -growing, -T[:n, n:])
    modes, shapes = cdf2rdf(*np.linalg.eig(growing))
    sizes = np.concatenate([np.ones(n), np.exp(-last * np.diag(modes)), [1.0]])
    S = V[:, :m] @ np.hstack([Q[:, :n], Q[:, n:] @ shapes])
    return block_diag(calm, modes, np.zeros((1, 1))), S, sizes


def _rows(maps: Array, values: Points) -> tuple[Array, Vector]:
    """Turn maps z -> x, (k, 3, d), into equations for all of z but its last entry, which is 1."""
    return maps[..., :-1].reshape(-1, maps.shape[-1] - 1), (values - maps[..., -1]).ravel()


def _constrained_lstsq(G: Array, g: Vector, K: Array, k: Vector) -> Vector:
    """Minimise |G z - g| subject to K z = k, in the null space of K."""
    inverse = np.linalg.pinv(K)
    free = np.linalg.svd(K)[2][len(K) :].T
    z = inverse @ k
    z = z + free @ np.linalg.lstsq(G @ free, g - G @ z, rcond=None)[0]
    return np.asarray(z + inverse @ (k - K @ z))
