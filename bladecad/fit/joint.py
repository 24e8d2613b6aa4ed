"""Both sides of all sections at once: the best coefficients that meet at the edges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from scipy.linalg import block_diag, null_space, qr, svd

from bladecad.arrays import Array
from bladecad.curves.outline import EdgeKind
from bladecad.fit.samples import Samples, by_section
from bladecad.fit.sidefit import Basis
from bladecad.fit.spectrum import Spectrum

JOINED: dict[EdgeKind, int] = {"round": 3, "sharp": 1, "blunt": 0}  # value, tangent, curvature
SMALLEST = 1e-9  # singular values below this share of the first carry no information


@final
@dataclass(frozen=True, eq=False)
class JointFit:
    """Coefficients of both sides.

    suction, pressure : (m, n, 3) float, mm, about the shared centre of the samples
    rank, free        : directions the data can tell apart, of the free coefficients there are
    condition         : first over last singular value kept, columns scaled to one
    """

    suction: Array
    pressure: Array
    rank: int
    free: int
    condition: float


def edge_conditions(S: Basis, P: Basis, le: EdgeKind, te: EdgeKind) -> Array:
    """Rows B with B (C_S, C_P) = 0 where the sides share value, tangent and curvature, (q, n).

    X_S = X_P, X_S' = -X_P', X_S'' = X_P'' at t = 0 and 1: the sides leave an edge in opposite
    directions with the same |dX/dt|, so what holds at the sections holds at every u.
    """
    rows = [
        np.concatenate([S(end, r)[0], -((-1.0) ** r) * P(end, r)[0]])
        for end, kind in ((np.zeros(1), le), (np.ones(1), te))
        for r in range(JOINED[kind])
    ]
    return np.array(rows).reshape(len(rows), S.size + P.size)


def solve_joint(
    spectra: tuple[Spectrum, Spectrum],
    samples: tuple[Samples, Samples],
    le: EdgeKind,
    te: EdgeKind,
    *,
    weights: tuple[Array, Array] | None = None,
) -> JointFit:
    """Solve for all coefficients of a blade, one least-squares problem for all sections.

    Minimises |Phi_S C_S - Y_S|^2 + |Phi_P C_P - Y_P|^2 subject to B (C_S, C_P) = 0, by the
    null-space method: C = N y with B N = 0. Columns are scaled to length one; directions that the
    data do not tell apart get the smallest coefficients.

    Parameters
    ----------
    spectra, samples : pairs, suction side first
        The samples are taken about one centre for both sides.
    weights : pair of (N,) float, optional
        Weights of the samples, for all sections alike.
    """
    (S, P), (on_S, on_P) = spectra, samples
    centre = 0.5 * (on_S.centre + on_P.centre)
    Phi = block_diag(S(on_S.t), P(on_P.t))
    Y = np.concatenate([on_S.about(centre), on_P.about(centre)])
    if weights is not None:
        w = np.sqrt(np.concatenate(weights))[:, None]
        Phi, Y = Phi * w, Y * w
    scale = 1.0 / np.linalg.norm(Phi, axis=0)
    B = unit_rows(edge_conditions(S, P, le, te) * scale)
    N = null_space(B) if len(B) else np.eye(len(scale))
    U, s, Vt = svd((Phi * scale) @ N, full_matrices=False)
    kept = s > SMALLEST * s[0]
    C = N @ (Vt[kept].T @ ((U[:, kept].T @ Y) / s[kept, None]))
    C = (C - B.T @ (B @ C) if len(B) else C) * scale[:, None]
    return JointFit(
        by_section(C[: S.size]) + S.one[:, None] * centre,
        by_section(C[S.size :]) + P.one[:, None] * centre,
        int(kept.sum()),
        len(kept),
        float(s[0] / s[kept][-1]),
    )


def unit_rows(B: Array) -> Array:
    """Orthonormal rows with the same null space, so that B B^T = 1."""
    return np.asarray(qr(B.T, mode="economic")[0].T) if len(B) else B
