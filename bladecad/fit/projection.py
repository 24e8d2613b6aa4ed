"""Variable projection: the rates of the modes with which a side is followed best."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.linalg.lapack import dposv

from bladecad.arrays import Array, Mask, Vector
from bladecad.fit.best_linear import BestLinear, best_linear, normal_equations
from bladecad.fit.spectrum import Spectrum

LOG_A = (float(np.log(8.0)), 8.5)
K = (-0.9, 20.0)
LONGEST = 1.0  # largest change of log a or k in one step
RESOLVED = 4  # samples next to an edge whose spacing bounds the rates there
ENOUGH = 1e-5  # relative gain of two steps below which the search stops
STUCK = 1e8  # damping at which no step is short enough to gain anything


def project(
    start: Spectrum,
    t: Vector,
    blocks: Sequence[Array],
    mix: Array | None = None,
    *,
    steps: int = 60,
) -> tuple[Spectrum, ...]:
    """Find the rates for which some coefficients follow the data best, downhill from a start.

    Minimises sum_b min_C |Phi(theta_b) C - Y_b|^2 over theta = (log a, k) of all pairs.

    Parameters
    ----------
    start : Spectrum
        Its degree, number of pairs and knots stay.
    t : (N,) float
    blocks : sequence of (N, d) float, mm
        Y_b. One block of all sections side by side shares one spectrum; a block a section does not.
    mix : (len(blocks), w) float, optional
        theta_b = sum_w mix[b, w] theta_w. One column of ones by default; columns (1-u, u) let the
        rates of a section vary linearly with its span u.
    steps : int
        Most Levenberg-Marquardt steps.

    Returns
    -------
    tuple of Spectrum
        One a block.

    Notes
    -----
    Golub and Pereyra, SIAM J. Numer. Anal. 10 (1973), with Kaufman's form of the Jacobian. What
    stands at a bound and is pulled against it takes no part in a step.
    """
    mix = np.ones((len(blocks), 1)) if mix is None else mix
    low, high = (np.tile(b, mix.shape[1]) for b in _bounds(start, t))
    theta = np.clip(np.tile(_pack(start), mix.shape[1]), low, high)
    best, damping, gains = _all(theta, mix, start, t, blocks), 1e-3, [1.0]
    while len(gains) <= steps and sum(gains[-2:]) > ENOUGH:
        H, g = _gathered(best, mix, t)
        free = ~((theta <= low) & (g < 0) | (theta >= high) & (g > 0))
        found = best
        while damping < STUCK and free.any():
            trial = np.clip(theta + _damped(H, g, free, damping), low, high)
            found = _all(trial, mix, start, t, blocks)
            if _rss(found) < _rss(best):
                break
            damping *= 8.0
        else:
            break
        gains.append(1.0 - _rss(found) / _rss(best))
        theta, best, damping = trial, found, max(damping / 5.0, 1e-9)
    return tuple(b.spectrum for b in best)


def reach(t: Vector) -> tuple[float, float]:
    """Largest log a that samples resolve at either edge: no mode decays within less than a step."""
    steps = np.diff(t)
    le, te = -np.log([steps[:RESOLVED].mean(), steps[-RESOLVED:].mean()])
    low, high = LOG_A
    return float(np.clip(le, low, high)), float(np.clip(te, low, high))


def _all(
    theta: Vector, mix: Array, like: Spectrum, t: Vector, blocks: Sequence[Array]
) -> list[BestLinear]:
    each = mix @ theta.reshape(mix.shape[1], -1)
    return [best_linear(_unpack(own, like), t, Y) for own, Y in zip(each, blocks, strict=True)]


def _rss(best: Sequence[BestLinear]) -> float:
    return sum(b.rss for b in best)


def _gathered(best: Sequence[BestLinear], mix: Array, t: Vector) -> tuple[Array, Vector]:
    """Normal equations for theta from those of every block."""
    parts = [normal_equations(b, t) for b in best]
    H, g = (np.array(each) for each in zip(*parts, strict=True))
    size = mix.shape[1] * g.shape[1]
    together = np.einsum("bv,bw,bij->viwj", mix, mix, H).reshape(size, size)
    return together, np.einsum("bw,bj->wj", mix, g).ravel()


def _damped(H: Array, g: Vector, free: Mask, damping: float) -> Vector:
    """Levenberg-Marquardt step of what is free, scaled so that all parameters count alike."""
    H, own = H[np.ix_(free, free)], g[free]
    scale = np.sqrt(np.maximum(np.diag(H), 0.0) + 1e-14 * abs(np.trace(H)))
    scaled = H / np.outer(scale, scale) + damping * np.eye(len(own))
    step = np.zeros(len(g))
    _, short, failed = dposv(scaled, own / scale)
    if failed:
        raise np.linalg.LinAlgError("normal equations of the rates are not positive definite")
    step[free] = np.clip(short / scale, -LONGEST, LONGEST)
    return step


def _bounds(like: Spectrum, t: Vector) -> tuple[Vector, Vector]:
    """Least and largest theta."""
    le, te = reach(t)
    pairs = len(like.le) + len(like.te)
    fastest = np.repeat([le, te], [len(like.le), len(like.te)])
    return np.tile([LOG_A[0], K[0]], pairs), np.stack([fastest, np.full(pairs, K[1])], 1).ravel()


def _pack(spectrum: Spectrum) -> Vector:
    modes = np.concatenate([spectrum.le, spectrum.te])
    return np.column_stack([np.log(modes[:, 0]), modes[:, 1]]).ravel()


def _unpack(theta: Vector, like: Spectrum) -> Spectrum:
    modes = theta.reshape(-1, 2)
    modes = np.column_stack([np.exp(modes[:, 0]), modes[:, 1]])
    cut = len(like.le)
    return Spectrum(like.degree, modes[:cut], modes[cut:], like.knots)
