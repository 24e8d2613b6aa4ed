"""Variable projection: the rates of the modes with which a side is followed best."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.linalg import lstsq

from bladecad.arrays import Array, Vector
from bladecad.fit.best_linear import BestLinear, best_linear, normal_equations
from bladecad.fit.spectrum import Spectrum

LOG_A = (float(np.log(8.0)), 8.5)
K = (-0.9, 20.0)
START_LOG_A, START_K = (float(np.log(30.0)), float(np.log(500.0))), 0.4
LONGEST = 1.0  # largest change of log a or k in one step
RESOLVED = 4  # samples next to an edge whose spacing bounds the rates there
ENOUGH = 1e-4  # relative gain below which the search stops


def first_guess(le: int, te: int, degree: int, knots: Sequence[float] = ()) -> Spectrum:
    """Spread the rates evenly over their usual range, a start from which the search converges."""
    return Spectrum(degree, _spread(le), _spread(te), np.array(knots))


def continued(found: Spectrum, le: int, te: int, degree: int) -> Spectrum:
    """Start from the rates of a spectrum already found: new pairs go where rates are missing."""
    return Spectrum(degree, _grown(found.le, le), _grown(found.te, te), found.knots)


def project(
    start: Spectrum,
    t: Vector,
    blocks: Sequence[Array],
    mix: Array | None = None,
    *,
    steps: int = 40,
) -> tuple[Spectrum, ...]:
    """Find the rates for which some coefficients follow the data best.

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
    Golub and Pereyra, SIAM J. Numer. Anal. 10 (1973), with Kaufman's form of the Jacobian.
    """
    mix = np.ones((len(blocks), 1)) if mix is None else mix
    theta = _bounded(np.tile(_pack(start), (mix.shape[1], 1)), start, t)
    best, damping = _all(theta, mix, start, t, blocks), 1e-3
    for _ in range(steps if theta.size else 0):
        H, g = _gathered(best, mix, t)
        before = _rss(best)
        while damping < 1e8:
            move = _damped(H, g, damping).reshape(theta.shape)
            trial = _bounded(theta + np.clip(move, -LONGEST, LONGEST), start, t)
            found = _all(trial, mix, start, t, blocks)
            if _rss(found) < before:
                break
            damping *= 8.0
        else:
            break
        theta, best, damping = trial, found, max(damping / 5.0, 1e-9)
        if _rss(best) > (1.0 - ENOUGH) * before:
            break
    return tuple(b.spectrum for b in best)


def _all(
    theta: Array, mix: Array, like: Spectrum, t: Vector, blocks: Sequence[Array]
) -> list[BestLinear]:
    return [best_linear(_unpack(w @ theta, like), t, Y) for w, Y in zip(mix, blocks, strict=True)]


def _rss(best: Sequence[BestLinear]) -> float:
    return sum(b.rss for b in best)


def _gathered(best: Sequence[BestLinear], mix: Array, t: Vector) -> tuple[Array, Vector]:
    """Normal equations for theta from those of every block."""
    parts = [normal_equations(b, t) for b in best]
    H = sum(np.kron(np.outer(w, w), Hb) for w, (Hb, _) in zip(mix, parts, strict=True))
    g = sum(np.kron(w, gb) for w, (_, gb) in zip(mix, parts, strict=True))
    return np.asarray(H), np.asarray(g)


def _damped(H: Array, g: Vector, damping: float) -> Vector:
    """Levenberg-Marquardt step, scaled so that all parameters count alike."""
    scale = np.sqrt(np.maximum(np.diag(H), 0.0) + 1e-14 * abs(np.trace(H)))
    scaled = H / np.outer(scale, scale) + damping * np.eye(len(g))
    return np.asarray(lstsq(scaled, g / scale)[0] / scale)


def _spread(pairs: int) -> Array:
    low, high = START_LOG_A
    places = (np.arange(pairs) + 0.5) / max(pairs, 1)
    return np.column_stack([np.exp(low + (high - low) * places), np.full(pairs, START_K)])


def _grown(pairs: Array, count: int) -> Array:
    """Keep at most `count` pairs, the fastest; add the usual rate furthest from those there are."""
    pairs = pairs[np.argsort(-pairs[:, 0])][:count]
    while len(pairs) < count:
        usual = _spread(count)
        away = np.abs(np.log(usual[:, :1]) - np.log(pairs[:, 0])).min(axis=1, initial=np.inf)
        pairs = np.vstack([pairs, usual[away.argmax()]])
    return pairs


def _pack(spectrum: Spectrum) -> Vector:
    modes = np.concatenate([spectrum.le, spectrum.te])
    return np.column_stack([np.log(modes[:, 0]), modes[:, 1]]).ravel()


def _unpack(theta: Vector, like: Spectrum) -> Spectrum:
    modes = theta.reshape(-1, 2)
    modes = np.column_stack([np.exp(modes[:, 0]), modes[:, 1]])
    cut = len(like.le)
    return Spectrum(like.degree, modes[:cut], modes[cut:], like.knots)


def _bounded(theta: Array, like: Spectrum, t: Vector) -> Array:
    """Keep every rate within reach of the samples: no mode decays within less than one step."""
    steps = np.diff(t)
    fastest = -np.log([steps[:RESOLVED].mean(), steps[-RESOLVED:].mean()])
    high = np.repeat(np.minimum(fastest, LOG_A[1]), [len(like.le), len(like.te)])
    pairs = theta.reshape(len(theta), -1, 2).copy()
    pairs[:, :, 0] = np.clip(pairs[:, :, 0], LOG_A[0], np.maximum(high, LOG_A[0]))
    pairs[:, :, 1] = np.clip(pairs[:, :, 1], *K)
    return pairs.reshape(theta.shape)
