"""Scans that are no blade, or not one: what they look like, and what to do."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.spatial import cKDTree

from bladecad.arrays import Points, Vector
from bladecad.errors import DataError
from bladecad.scans.finding.several import on_a_hub
from bladecad.scans.finding.sheets import sheets
from bladecad.scans.finding.skeleton import legendre

FEWEST: Final = 600  # points from which a blade is told
FLAT: Final = 1e-3  # of the largest extent, rms
SHEET: Final = 3e-3  # of the size, rms: points that lie on one smooth sheet
DEGREE: Final = 7  # of that sheet
LAYERS: Final = 400  # heights in which stacked sections leave most empty
FILLED: Final = 0.25  # of them
CELLS: Final = (16, 16)  # of the principal plane, in which sheets are counted
OPEN: Final = 0.5  # of them with one sheet alone
PROBES: Final = 400  # points whose neighbours are looked at
THIN: Final = 0.15  # width over length of neighbours that lie on a line


def refuse_few_or_flat(points: Points) -> None:
    """Refuse scans with few points, or all on one line or plane.

    Raises
    ------
    DataError
    """
    if len(points) < FEWEST:
        raise DataError(
            f"the scan has {len(points)} points, {FEWEST} are needed to find a blade in it; "
            "if they are sections, give a file that says so"
        )
    size = _extents(points)
    if size[2] <= FLAT * size[0]:
        where = "plane" if size[1] > FLAT * size[0] else "line"
        raise DataError(
            f"all points of the scan lie on one {where}: {size[2]:.3g} mm rms across it, more than "
            f"{FLAT * size[0]:.3g} mm is needed; scan both sides of the blade"
        )


def several_blades(count: int) -> DataError:
    """Say that a scan holds several blades."""
    return DataError(
        f"the scan holds {count} blades; cut one out, or give --allow-partial to build the one "
        "with the most points"
    )


def no_blade(points: Points) -> DataError:
    """Say why points are no blade: one side of it, several blades, sections, anything."""
    if _sheet(points):
        return DataError(
            "the scan is open: its points lie on one smooth sheet, one side of a blade at most; a "
            "solid needs both: scan the other side, too"
        )
    layers = _layers(points)
    if layers or _lines(points):
        where = f"{layers} planes" if layers else "lines"
        return DataError(
            f"the points of the scan lie on {where} with nothing between them: these are "
            "sections; give a file of sections"
        )
    count = on_a_hub(points).blades
    if count > 1:
        return several_blades(count)
    missing = _one_sheet(points)
    if missing > OPEN:
        return DataError(
            f"the scan is open: over {missing:.0%} of its extent its points lie on one sheet; a "
            "solid needs both sides of the blade: scan the other side, too"
        )
    size = _extents(points)
    return DataError(
        f"the scan is no blade: it is {size[2] / size[1]:.0%} as thick as wide, and no direction "
        "cuts it into slender closed loops that change slowly; if it is one, give --axis and --span"
    )


def _extents(points: Points) -> Vector:
    X = points - points.mean(axis=0)
    return np.asarray(np.sqrt(np.maximum(np.linalg.eigvalsh(X.T @ X / len(X))[::-1], 0.0)))


def _principal(points: Points) -> Points:
    X = points - points.mean(axis=0)
    return np.asarray(X @ np.linalg.eigh(X.T @ X)[1][:, ::-1])


def _sheet(points: Points) -> bool:
    """Whether points lie on one smooth sheet over their principal plane."""
    x, y, z = _principal(points).T
    size = float(np.hypot(np.ptp(x), np.ptp(y)))
    A = (
        legendre(2.0 * (x - x.min()) / np.ptp(x) - 1.0, DEGREE)[:, :, None]
        * legendre(2.0 * (y - y.min()) / np.ptp(y) - 1.0, DEGREE)[:, None, :]
    ).reshape(len(x), -1)
    off = z - A @ np.linalg.lstsq(A, z)[0]
    return bool(np.sqrt(np.mean(off**2)) < SHEET * size)


def _layers(points: Points) -> int:
    """On how many planes across x, y, z or a principal axis all points lie; 0 if they do not."""
    for X in (points, _principal(points)):
        for h in X.T:
            bins = np.histogram(h, LAYERS)[0] > 0
            if bins.mean() < FILLED:
                return int(bins[0]) + int((np.diff(bins.astype(int)) > 0).sum())
    return 0


def _lines(points: Points) -> bool:
    """Whether the nearest neighbours of most points lie on a line."""
    _, near = cKDTree(points).query(points[:: max(len(points) // PROBES, 1)], 7)
    X = points[near] - points[near].mean(axis=1, keepdims=True)
    length = np.sqrt(np.maximum(np.linalg.eigvalsh(np.einsum("kix,kiy->kxy", X, X)), 0.0))
    return bool(np.median(length[:, 1] / np.maximum(length[:, 2], 1e-300)) < THIN)


def _one_sheet(points: Points) -> float:
    """Over which share of the principal plane points lie on one sheet."""
    flat = _principal(points)
    low, wide = flat.min(axis=0), np.ptp(flat, axis=0)
    x, y, z = ((flat - low) / np.maximum(wide, 1e-300)).T
    cells = sheets(x, y, z, CELLS)
    return float(cells.one.sum() / max(cells.judged.sum(), 1))
