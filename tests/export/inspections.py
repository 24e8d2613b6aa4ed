"""Inspections of blades with deviations that are known, made without measuring."""

from __future__ import annotations

from functools import cache
from types import SimpleNamespace

import numpy as np

from bladecad.curves.sides import split_sides
from bladecad.data.scan import Scan
from bladecad.data.sections import Source
from bladecad.data.synthetic import synthetic_blade
from bladecad.deviation.inspecting.coverage import Map
from bladecad.deviation.inspecting.inspection import Inspection, Worst
from bladecad.deviation.inspecting.zones import ZoneResult
from bladecad.deviation.nearest.feet import Feet
from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.deviation.nearest.referee import Referee
from bladecad.deviation.sectioning.parameters import Number
from bladecad.deviation.sectioning.section_result import SectionResult
from bladecad.export.check.zones import bounds_at, zone_at
from bladecad.fit.blade import Order
from bladecad.pipeline import Settings, fit, surface_of
from bladecad.surface.blade import BladeSurface, normals, outward
from bladecad.surface.loft import SIDES, graded
from bladecad.tolerance import ZONES, Band, Tolerances

T = np.array([[0.96, -0.28, 0.0, 3.0], [0.28, 0.96, 0.0, -4.0], [0, 0, 1.0, 12.0], [0, 0, 0, 1.0]])
TOLERANCES = Tolerances(
    {**dict.fromkeys(ZONES, Band(-0.05, 0.05)), "leading edge": Band(-0.03, 0.04)},
    parameters={"chord": Band(-0.1, 0.1)},
    le_zone=0.05, te_zone=0.04, hub_margin=0.1, tip_margin=0.05,
)  # fmt: skip


@cache
def blade(trailing_edge: str = "round") -> BladeSurface:
    sections = synthetic_blade(5, 80, trailing_edge=trailing_edge)
    return surface_of(fit(split_sides(sections), Settings(order=Order(2, 2, 9), tolerance=0.05)))


def bump(side: int, u, t):
    """What stands on the blade, mm: a bump on the suction side, a worn leading edge."""
    on = 0.12 * np.exp(-((u - 0.6) ** 2 + (t - 0.4) ** 2) / 0.01) if side == 0 else 0.0
    return on - 0.06 * np.exp(-t / 0.03) * (u > 0.3) + 0.01 * np.sin(9 * u + 7 * t)


def inspection(
    surface: BladeSurface | None = None,
    *,
    count: int = 4000,
    stations: int = 3,
    cells: tuple[int, int] = (16, 24),
    name: str = "S",
    missing: bool = True,
    tolerances: Tolerances = TOLERANCES,
) -> Inspection:
    """A blade with `bump` on it; nothing is measured on the pressure side above u = 0.7."""
    surface = surface or blade()
    feet = _feet(surface, count, missing)
    zone = zone_at(tolerances, feet.suction, feet.u, feet.t)
    zone[feet.rim] = -1
    points = (feet.foot + feet.distance[:, None] * feet.normal - T[:3, 3]) @ T[:3, :3]
    sections = tuple(
        _section(surface, f"{name}{i + 1}", u, i == 1, missing)
        for i, u in enumerate(np.linspace(0.12, 0.9, stations))
    )
    return Inspection(
        nominal_of(surface), Scan(points, None, Source(None, "made up")), registration(), feet,
        zone.astype(np.int8), _zones(tolerances, feet, zone), _map(feet, cells), sections,
        _worst(feet, zone, tolerances, sections), Referee(1000, 3e-4, 1e-3), tolerances,
        int(feet.rim.sum()), {"projection": 0.8, "sections": 0.3},
    )  # fmt: skip


def registration() -> SimpleNamespace:
    return SimpleNamespace(
        T_nominal_scan=T, kind="best", locked=(), covariance=np.diag([1e-8] * 3 + [1e-10] * 3),
        centre=np.zeros(3), rms=0.011, largest=0.13, used=3000, far=2, steps=7,
    )  # fmt: skip


def _feet(surface: BladeSurface, count: int, missing: bool) -> Feet:
    rng = np.random.default_rng(1)
    u, t = rng.uniform(-0.01, 1.01, count), rng.beta(0.7, 0.7, count)
    suction = rng.random(count) < 0.5
    keep = suction | (u < 0.7) | (not missing)
    u, t, suction = u[keep], t[keep], suction[keep]
    rim = (u <= 0) | (u >= 1)
    u = np.clip(u, 0, 1)
    at, n = np.empty((len(u), 3)), np.empty((len(u), 3))
    for side, mask in zip(SIDES, (suction, ~suction), strict=True):
        at[mask] = surface.at(side, u[mask], t[mask])
        cross = np.cross(
            surface.at(side, u[mask], t[mask], 1, 0), surface.at(side, u[mask], t[mask], 0, 1)
        )
        n[mask] = outward(surface, side) * cross / np.linalg.norm(cross, axis=1)[:, None]
    d = np.where(suction, bump(0, u, t), bump(1, u, t)) + rng.normal(0, 0.004, len(u))
    return Feet(d, at, n, np.where(suction, 0, 1).astype(np.int8), suction, u, t, rim)


def _map(feet: Feet, cells: tuple[int, int]) -> Map:
    a, b = cells
    u, t = np.linspace(0, 1, a + 1), graded(b + 1)
    i, j = (
        np.clip(np.searchsorted(x, y) - 1, 0, len(x) - 2) for x, y in ((u, feet.u), (t, feet.t))
    )
    flat = np.ravel_multi_index((1 - feet.suction.astype(int), i, j), (2, a, b))[~feet.rim]
    d, size = feet.distance[~feet.rim], 2 * a * b
    count = np.bincount(flat, minlength=size)
    low, high = np.full(size, np.inf), np.full(size, -np.inf)
    np.minimum.at(low, flat, d)
    np.maximum.at(high, flat, d)
    with np.errstate(invalid="ignore"):
        mean = np.bincount(flat, d, size) / count
    none = count == 0
    low[none] = high[none] = np.nan
    return Map(u, t, *(x.reshape(2, a, b) for x in (count, mean, low, high)),
               np.ones((2, a, b)), (count > 0).reshape(2, a, b))  # fmt: skip


def _zones(tolerances: Tolerances, feet: Feet, zone: np.ndarray) -> tuple[ZoneResult, ...]:
    found = []
    for name in tolerances.present:
        d = feet.distance[zone == ZONES.index(name)]
        band = tolerances.zones[name]
        out = int((band.excess(d) > 0).sum())
        if len(d):
            rms, p99 = np.sqrt((d**2).mean()), np.quantile(np.abs(d), 0.99)
            numbers = [float(x) for x in (d.min(), d.max(), d.mean(), rms, p99)]
        else:
            numbers = [np.nan] * 5
        found.append(ZoneResult(name, band, len(d), out, 100.0, 80.0, 5.0, *numbers))
    return tuple(found)


def _section(
    surface: BladeSurface, name: str, u: float, poor: bool, missing: bool
) -> SectionResult:
    t = graded(61)
    X, n, dev, side, place = [], [], [], [], []
    for k, s in enumerate(SIDES):
        order = slice(None) if k == 0 else slice(-2, 0, -1)
        at = t[order]
        X.append(surface(s, np.array([u]), at)[0])
        n.append(normals(surface, s, np.array([u]), at)[0])
        dev.append(bump(k, u, at) * np.where((k == 1) & (u > 0.7) & missing, np.nan, 1.0))
        side.append(np.full(len(at), k == 0))
        place.append(at)
    X, n = np.concatenate(X), np.concatenate(n)
    e = X[60] - X[0]
    e = e / np.linalg.norm(e)
    across = n[side[0].nonzero()[0][30]]
    across = across - (across @ e) * e
    rows = np.stack([e, across / np.linalg.norm(across)])
    flat, flat_n = (X - X[0]) @ rows.T, n @ rows.T
    flat_n = flat_n / np.linalg.norm(flat_n, axis=1)[:, None]
    deviation = np.concatenate(dev)
    return SectionResult(
        name, u, X, n, flat, flat_n, np.concatenate(side), np.concatenate(place), deviation,
        np.where(np.isnan(deviation), np.nan, 0.004), _numbers(poor), (fitted(),), 240,
    )  # fmt: skip


def fitted() -> SimpleNamespace:
    return SimpleNamespace(
        kind="least squares", shift=np.array([0.012, -0.03]), twist=0.001,
        before=(-0.07, 0.12, 0.03), after=(-0.05, 0.09, 0.02),
    )  # fmt: skip


def _numbers(poor: bool) -> tuple[Number, ...]:
    chord = 40.123 if not poor else 40.42
    return (
        Number("chord", "mm", 40.1, chord, 0.01, Band(-0.1, 0.1)),
        Number("stagger", "deg", 31.2, 31.25, 0.02),
        Number(
            "leading edge thickness at 0.5 mm", "mm", 0.61, None, None, reason="no points there"
        ),
        Number(
            "trailing edge radius", "mm", None, float("nan"), None, reason="the edge is cut off"
        ),
    )


def _worst(feet, zone, tolerances, sections) -> tuple[Worst, ...]:
    bounds = bounds_at(tolerances, feet.suction, feet.u, feet.t)
    excess = np.maximum(feet.distance - bounds[:, 1], bounds[:, 0] - feet.distance)
    excess[feet.rim] = -np.inf
    found = []
    for k in np.argsort(-excess)[[0, 7, 21][: 1 + (len(excess) > 21) * 2]]:
        nearest = min(sections, key=lambda s: abs(s.u - feet.u[k]), default=None)
        side = "suction" if feet.suction[k] else "pressure"
        place = float(feet.u[k]), float(feet.t[k]), feet.foot[k], int(k)
        out = float(feet.distance[k]), float(excess[k])
        found.append(Worst(ZONES[zone[k]], nearest.name if nearest else "", side, *place, *out))
    return tuple(found)


def checked(
    found: Inspection | None = None, *, name: str = "blade", notes: tuple[str, ...] = ()
) -> SimpleNamespace:
    """A finished check around an inspection."""
    found = found or inspection()
    scan = {"file": "scan.ply", "sha256": "cd" * 32, "unit": "mm", "points": len(found.zone)}
    return SimpleNamespace(
        name=name,
        settings=Settings(),
        notes=notes,
        inspection=found,
        inputs={"nominal": {"file": "n.json", "sha256": "ab" * 32, "unit": "mm"}, "scan": scan},
    )
