"""Made-up scans of blades that are known exactly, and the distance of a fit from them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache, cached_property
from pathlib import Path

import numpy as np
import pytest
from numba import njit
from scipy.spatial.transform import Rotation
from threadpoolctl import threadpool_limits

from bladecad.curves.outliers import keep_masks, misprints
from bladecad.curves.repair import repaired
from bladecad.curves.sides import split_sides
from bladecad.data.profile import Profile
from bladecad.data.read import read_sections
from bladecad.data.scan import Scan
from bladecad.data.sections import Source
from bladecad.data.synthetic import profiles
from bladecad.deviation.nearest.newton import evaluate
from bladecad.deviation.nearest.nominal import Nominal, nominal_of
from bladecad.deviation.nearest.project import project
from bladecad.fit.order import fit_blade
from bladecad.surface.blade import BladeSurface
from bladecad.surface.loft import SIDES, graded
from tests.scans.analytic import AnalyticBlade
from tests.scans.root import Root, Stand, cap, strips

ROOT = Path(__file__).resolve().parents[2]
SHARED = ROOT.parent / "shared" / "data"
FILES = {
    "rotor37": ROOT / "fixtures" / "rotor37" / "sections.csv",
    "hannover": SHARED / "hannover-4ac-front" / "1_Rotor1_Blade.crv",
    "hannover-igv": SHARED / "hannover-4ac-front" / "0_IGV_Vane.crv",
    "hannover-stator": SHARED / "hannover-4ac-front" / "2_Stator1_Vane.crv",
    "stac": SHARED / "stac-turbine" / "R1_TS-3_profile.crv",
}
EDGE = 0.02  # of t: the zones of the edges
AIRFOIL, FOOT, TIP, OUTLIER = range(4)  # what a point of a scan is of
FINE = 5  # parts of a square each way, in which points are strewn evenly


def _profile(u, **other):
    return Profile(**({"height": 180.0 + 70.0 * u} | other))


ANALYTIC = {
    "synthetic": lambda: AnalyticBlade(*profiles(3)),
    "synthetic-thick": lambda: AnalyticBlade(*(
        _profile(u, length=40 - 4 * u, turning=0.9 - 0.5 * u, stagger=0.5 + 0.4 * u,
                 thickness=5.0 - 2.0 * u, radius_le=0.55 - 0.2 * u, radius_te=0.4 - 0.1 * u)
        for u in (0.0, 0.5, 1.0))),
    "synthetic-small": lambda: AnalyticBlade(*(
        _profile(0.0, height=90 + 28 * u, length=22 - 2 * u, turning=0.5 - 0.2 * u,
                 stagger=0.7 + 0.25 * u, thickness=1.9 - 0.7 * u, radius_le=0.14 - 0.03 * u,
                 radius_te=0.12 - 0.02 * u)
        for u in (0.0, 0.5, 1.0))),
}  # fmt: skip
TRUTHS = (*ANALYTIC, *FILES)


@cache
def truth_surface(name="rotor37"):
    """A blade whose surface is taken as true: fitted to a file, or in closed form.

    "rotor37", "hannover", "hannover-igv", "hannover-stator", "stac" are modal fits to sections;
    "synthetic", "synthetic-thick", "synthetic-small" are no flows at all.
    """
    if name in ANALYTIC:
        return ANALYTIC[name]()
    if not FILES[name].exists():
        pytest.skip(f"{FILES[name]} is not there")
    sections = repaired(read_sections(FILES[name]))
    with threadpool_limits(1):
        lines = split_sides(sections, keep=list(keep_masks(sections, misprints(sections))))
        found = fit_blade(lines, tolerance=0.012)
    return BladeSurface(lines.span, found.suction, found.pressure, le=lines.le, te=lines.te)


@cache
def nominal_for(surface) -> Nominal:
    """The skin of a truth, cut once."""
    return nominal_of(surface)


@dataclass(frozen=True, eq=False)
class Distance:
    """How far a fitted surface is from the truth, at places spread over it.

    normal : (k,) mm, along the normal of the truth, positive outside
    weight : (k,) mm^2, area that each place stands for
    u, t, suction : where on the truth
    counts : (k,) supported: not beyond the span that was scanned, not in the hole
    """

    normal: np.ndarray
    weight: np.ndarray
    u: np.ndarray
    t: np.ndarray
    suction: np.ndarray
    counts: np.ndarray

    @property
    def le(self):
        return self.counts & (self.t <= EDGE)

    @property
    def te(self):
        return self.counts & (self.t >= 1.0 - EDGE)

    @property
    def body(self):
        return self.counts & (self.t > EDGE) & (self.t < 1.0 - EDGE)

    def rms(self, mask=None):
        mask = self.counts if mask is None else mask
        return float(np.sqrt(np.average(self.normal[mask] ** 2, weights=self.weight[mask])))

    def largest(self, mask=None):
        return float(np.abs(self.normal[self.counts if mask is None else mask]).max())

    @property
    def left_out(self):
        """Share of the area that does not count."""
        return float(self.weight[~self.counts].sum() / self.weight.sum())

    def __str__(self):
        parts = {"all": self.counts, "body": self.body, "LE": self.le, "TE": self.te}
        said = (f"{k} {1e3 * self.rms(m):.2f}/{1e3 * self.largest(m):.1f}"
                for k, m in parts.items() if m.any())  # fmt: skip
        return f"rms/max um: {', '.join(said)}; {self.left_out:.1%} left out"


def distance_to_truth(
    fitted,
    truth,
    pose=None,
    *,
    supported: Callable | None = None,
    grid=(161, 401),
) -> Distance:
    """Measure a fitted surface, in the frame of the scan, against the truth in its own.

    Parameters
    ----------
    fitted, truth : surfaces
    pose : (R, t), optional
        x_scan = R x_truth + t.
    supported : callable, optional
        From points in the frame of the truth and their feet to a mask of those that count.
    """
    R, shift = pose if pose is not None else (np.eye(3), np.zeros(3))
    u = np.linspace(0.0, 1.0, grid[0])
    t = np.union1d(graded(grid[1]), np.linspace(0.0, 1.0, grid[1] // 2))
    area = np.outer(np.gradient(u), np.gradient(t))
    points, weights = [], []
    for name in SIDES:
        n = np.cross(fitted(name, u, t, 1, 0), fitted(name, u, t, 0, 1))
        weights.append((area * np.linalg.norm(n, axis=2)).ravel())
        points.append(fitted(name, u, t).reshape(-1, 3))
    X = (np.concatenate(points) - shift) @ R
    feet = project(nominal_for(truth), X)
    counts = ~feet.rim
    if supported is not None:
        counts &= supported(X, feet)
    return Distance(feet.distance, np.concatenate(weights), feet.u, feet.t, feet.suction, counts)


@dataclass(frozen=True, eq=False)
class SyntheticScan:
    """A made-up scan: what was measured, and what is true.

    points    : (k, 3) mm, in the frame of the scan
    triangles : (m, 3) or None
    surface   : the truth, in its own frame
    pose      : (R, t), x_scan = R x_truth + t
    kind      : (k,) AIRFOIL, FOOT (fillet, platform, root), TIP or OUTLIER
    sigma     : mm, of the noise
    hole      : (side, u0, u1, t0, t1) or None
    stand     : the root, None without
    u, t, suction : of the airfoil points, NaN of the others
    """

    points: np.ndarray
    triangles: np.ndarray | None
    surface: object
    pose: tuple[np.ndarray, np.ndarray]
    kind: np.ndarray
    sigma: float
    hole: tuple | None
    stand: Stand | None
    u: np.ndarray = field(repr=False)
    t: np.ndarray = field(repr=False)
    suction: np.ndarray = field(repr=False)

    @cached_property
    def scan(self) -> Scan:
        """As `read_scan` would give it."""
        return Scan(self.points, self.triangles, Source(None, "made up"))

    @property
    def axis(self):
        """The stacking axis in the frame of the scan, hub to tip."""
        t = np.linspace(0.0, 1.0, 101)
        ends = sum(self.surface(s, np.array([0.0, 1.0]), t).mean(axis=1) for s in SIDES)
        along = self.pose[0] @ (ends[1] - ends[0])
        return along / np.linalg.norm(along)

    def to_truth(self, points):
        """Points of the scan in the frame of the truth."""
        return (points - self.pose[1]) @ self.pose[0]

    def supported(self, X, feet):
        """Which places, in the frame of the truth, were scanned: off the fillet and the hole."""
        counts = np.ones(len(X), bool)
        if self.stand is not None:
            counts &= self.stand.height(X) > self.stand.fillet
        if self.hole is not None:
            counts &= ~inside(self.hole, feet.suction, feet.u, feet.t)
        return counts

    def distance(self, fitted) -> Distance:
        """How far a surface fitted to this scan is from the truth, where it was scanned."""
        return distance_to_truth(fitted, self.surface, self.pose, supported=self.supported)

    def write(self, path, unit=1.0):
        """Write it in the format that the suffix says: ply, stl, xyz, csv."""
        points = self.points / unit
        if path.suffix in (".xyz", ".csv"):
            comma = "," if path.suffix == ".csv" else " "
            np.savetxt(path, points, fmt="%.6f", delimiter=comma)
            return path
        import trimesh

        made = (trimesh.PointCloud(points) if self.triangles is None
                else trimesh.Trimesh(points, self.triangles, process=False))  # fmt: skip
        made.export(path)
        return path


def inside(hole, suction, u, t):
    """Which places are in a hole."""
    side, u0, u1, t0, t1 = hole
    return (suction == (side == "suction")) & (u > u0) & (u < u1) & (t > t0) & (t < t1)


def scan_of(
    surface,
    count=100_000,
    *,
    sigma=0.0,
    noise="normal",
    outliers=0.0,
    hole=None,
    pose=None,
    edges=1.0,
    span=(0.0, 1.0),
    density=None,
    root=None,
    tip=False,
    seed=0,
    mesh=False,
) -> SyntheticScan:
    """Scan a blade.

    Parameters
    ----------
    surface : truth
    count : int
        Points on the airfoil, evenly over its area, before edges are thinned out.
    sigma : float
        mm, of the noise, along the normal or, `noise="isotropic"`, of each coordinate.
    outliers : float
        Share of the airfoil points; half of them far away, half 0.1 to 2 mm off the airfoil.
    hole : (side, u0, u1, t0, t1)
    pose : "any", (R, t), None
    edges : float
        Share of the points kept where t is within `EDGE` of an edge.
    density : callable
        u, t -> share of the points kept there, for scanners that adapt.
    span : (u0, u1)
        What of the airfoil is scanned.
    root : bool or Root
        Fillet, platform and fir tree as well; the airfoil then begins above the fillet.
    tip : bool
        The face over the tip as well.
    mesh : bool
        Triangles: vertices on a grid that was shaken, noise on them; `edges` widens the grid.
    """
    rng = np.random.default_rng(seed)
    stand = Stand(surface, Root() if root is True else root) if root else None
    make = _mesh if mesh else _cloud
    X, N, kind, place, triangles = make(surface, count, stand, span, tip, edges, rng)
    suction, u, t = place
    keep = np.ones(len(X), bool)
    airfoil = kind == AIRFOIL
    if hole is not None:
        keep &= ~(airfoil & inside(hole, suction, u, t))
    if not mesh:
        near = np.minimum(t, 1.0 - t) < EDGE
        keep &= ~(airfoil & near) | (rng.random(len(X)) < edges)
    if density is not None:
        keep &= ~airfoil | (rng.random(len(X)) < density(u, t))
    X, N, kind, suction, u, t = (a[keep] for a in (X, N, kind, suction, u, t))
    if triangles is not None:
        number = np.where(keep, np.cumsum(keep) - 1, -1)
        triangles = number[triangles]
        triangles = triangles[(triangles >= 0).all(axis=1)]
    if noise == "normal":
        X = X + (sigma * rng.standard_normal(len(X)))[:, None] * N
    else:
        X = X + sigma * rng.standard_normal(X.shape)
    X, kind, suction, u, t = _with_outliers(X, N, kind, suction, u, t, outliers, mesh, rng)
    if triangles is None:
        order = rng.permutation(len(X))
        X, kind, suction, u, t = (a[order] for a in (X, kind, suction, u, t))
    R, shift = _pose(pose, rng)
    points = X @ R.T + shift
    return SyntheticScan(
        points, triangles, surface, (R, shift), kind, sigma, hole, stand, u, t, suction
    )


def _pose(pose, rng):
    if pose is None:
        return np.eye(3), np.zeros(3)
    if isinstance(pose, str):
        return Rotation.random(random_state=rng).as_matrix(), rng.uniform(-200.0, 200.0, 3)
    return np.asarray(pose[0], float), np.asarray(pose[1], float)


def _with_outliers(X, N, kind, suction, u, t, share, mesh, rng):
    airfoil = np.flatnonzero(kind == AIRFOIL)
    count = round(share * len(airfoil))
    near = rng.choice(airfoil, count if mesh else count // 2, replace=False)
    off = rng.uniform(0.1, 2.0, len(near)) * rng.choice([-1.0, 1.0], len(near))
    X, kind = X.copy(), kind.copy()
    X[near] += off[:, None] * N[near]
    kind[near] = OUTLIER
    if mesh:
        return X, kind, suction, u, t
    low, high = X.min(axis=0), X.max(axis=0)
    far = low + (high - low) * rng.uniform(-0.3, 1.3, (count - len(near), 3))
    nan = np.full(len(far), np.nan)
    return (
        np.concatenate([X, far]), np.concatenate([kind, np.full(len(far), OUTLIER)]),
        np.concatenate([suction, np.zeros(len(far), bool)]),
        np.concatenate([u, nan]), np.concatenate([t, nan]),
    )  # fmt: skip


@njit(cache=True)
def _evaluated(c, item, place, X, N):
    rows = np.empty((6, 3))
    for k in range(len(item)):
        evaluate(c, item[k], place[k, 0], place[k, 1], rows)
        a, b = rows[1], rows[2]
        X[k] = rows[0]
        N[k, 0] = a[1] * b[2] - a[2] * b[1]
        N[k, 1] = a[2] * b[0] - a[0] * b[2]
        N[k, 2] = a[0] * b[1] - a[1] * b[0]


@cache
def _areas(surface):
    """Area of every small part of every square of both sides, (n, FINE^2)."""
    squares = nominal_for(surface).sides.squares
    x = (np.arange(FINE) + 0.5) / FINE
    v, w = np.meshgrid(x, x, indexing="ij")
    place = np.tile(np.column_stack([v.ravel(), w.ravel()]), (len(squares.c), 1))
    X, N = np.empty((2, len(place), 3))
    _evaluated(squares.c, np.repeat(np.arange(len(squares.c)), FINE**2), place, X, N)
    area = np.linalg.norm(N, axis=1).reshape(-1, FINE**2) / FINE**2
    return area * (squares.face < 2)[:, None]


@cache
def _grid(surface):
    """Of either side: its borders in u and in t, and the number of its first square."""
    squares = nominal_for(surface).sides.squares
    found = []
    for face in (0, 1):
        own = np.flatnonzero(squares.face == face)
        u0, _, t0, _ = squares.domain[own].T
        found.append((np.unique(u0), np.unique(t0), own[0]))
    return found


def on_surface(surface, suction, u, t):
    """X and outward normals at places of the truth, quickly."""
    squares = nominal_for(surface).sides.squares
    item = np.empty(len(u), np.int64)
    for face, on in ((0, suction), (1, ~suction)):
        u0, t0, first = _grid(surface)[face]
        i, j = (np.searchsorted(a, x, "right") - 1 for a, x in ((u0, u[on]), (t0, t[on])))
        item[on] = first + i * len(t0) + j
    domain = squares.domain[item]
    place = np.column_stack([(u - domain[:, 0]) / domain[:, 1], (t - domain[:, 2]) / domain[:, 3]])
    X, N = np.empty((2, len(u), 3))
    _evaluated(squares.c, item, place, X, N)
    return X, N * (squares.sign[item] / np.linalg.norm(N, axis=1))[:, None]


def strewn(surface, count, rng):
    """Points evenly over both sides: X, outward normals, suction, u and t."""
    squares, area = nominal_for(surface).sides.squares, _areas(surface)
    counts = rng.multinomial(count, area.ravel() / area.sum())
    part = np.repeat(np.arange(area.size), counts)
    item, part = np.divmod(part, FINE**2)
    place = (np.column_stack(np.divmod(part, FINE)) + rng.random((count, 2))) / FINE
    X, N = np.empty((2, count, 3))
    _evaluated(squares.c, item, place, X, N)
    N *= (squares.sign[item] / np.linalg.norm(N, axis=1))[:, None]
    domain = squares.domain[item]
    u, t = domain[:, 0] + place[:, 0] * domain[:, 1], domain[:, 2] + place[:, 1] * domain[:, 3]
    return X, N, squares.face[item] == 0, u, t


def _cloud(surface, count, stand, span, tip, edges, rng):
    X, N, suction, u, t = strewn(surface, count, rng)
    keep = (u >= span[0]) & (u <= span[1])
    if stand is not None:
        keep &= stand.height(X) > stand.fillet
    if not keep.all():  # once more, so that as many remain as were asked
        count = round(count / max(keep.mean(), 0.05))
        X, N, suction, u, t = strewn(surface, count, rng)
        keep = (u >= span[0]) & (u <= span[1])
        if stand is not None:
            keep &= stand.height(X) > stand.fillet
        X, N, suction, u, t = (a[keep] for a in (X, N, suction, u, t))
    per_area = count / _areas(surface).sum()
    parts = [(X, N, np.full(len(X), AIRFOIL))]
    if stand is not None:
        parts.append(
            _strewn_tube(stand.rings, stand.chart.out, stand.root.density * per_area, FOOT, rng)
        )
    if tip:
        parts.append(_strewn_tube(cap(surface), lambda X: X, per_area, TIP, rng))
    X, N, kind = (np.concatenate(a) for a in zip(*parts, strict=True))
    more = len(X) - len(u)
    nan = np.full(more, np.nan)
    place = (np.concatenate([suction, np.zeros(more, bool)]), np.concatenate([u, nan]),
             np.concatenate([t, nan]))  # fmt: skip
    return X, N, kind, place, None


def _strewn_tube(rings, out, per_area, kind, rng):
    """Points evenly over a tube of loops given in some coordinates."""
    corners = rings.reshape(-1, 3)[strips(*rings.shape[:2])]
    a, b, c = np.moveaxis(out(corners), 1, 0)
    n = np.cross(b - a, c - a)
    size = np.linalg.norm(n, axis=1)
    counts = rng.poisson(0.5 * size * per_area)
    item = np.repeat(np.arange(len(corners)), counts)
    s, t = rng.random((2, len(item)))
    s, t = np.where(s + t > 1, 1 - s, s), np.where(s + t > 1, 1 - t, t)
    corners = corners[item]
    X = out(corners[:, 0] + s[:, None] * (corners[:, 1] - corners[:, 0])
            + t[:, None] * (corners[:, 2] - corners[:, 0]))  # fmt: skip
    N = n[item] / size[item, None]
    return X, N, np.full(len(X), kind)


def _mesh(surface, count, stand, span, tip, edges, rng):
    """Loops from the tip down, of shaken places, and the triangles between them."""
    length = np.linalg.norm(np.diff(surface("suction", np.array([0.5]), np.linspace(0, 1, 200))[0],
                                    axis=0), axis=1).sum()  # fmt: skip
    tall = nominal_for(surface).length * (span[1] - span[0])
    columns = max(round(np.sqrt(count * length / (2 * tall))), 20)
    rows = max(count // (2 * columns), 10)
    t = np.linspace(0.0, 1.0, columns + 1)
    if edges != 1.0:
        near = np.minimum(t, 1.0 - t) < EDGE
        t = t[~near | (np.arange(len(t)) % max(round(1 / edges), 1) == 0)]
        t = np.unique(np.concatenate([[0.0], t, [1.0]]))
    fall = np.linspace(1.0, 0.0, rows)  # from the tip to the fillet
    every = []
    for name, along in (("suction", t), ("pressure", t[-2:0:-1])):
        low = np.full(len(along), span[0]) if stand is None else stand.begins(name, along)
        T, F = np.tile(along, (rows, 1)), np.tile(fall[:, None], (1, len(along)))
        T = T + rng.uniform(-0.3, 0.3, T.shape) * np.gradient(along) * ((along > 0) & (along < 1))
        F[1:-1] += rng.uniform(-0.3, 0.3, F[1:-1].shape) / rows
        U = low + F * (span[1] - low)
        on = np.full(U.shape, name == "suction")
        X, n = on_surface(surface, on.ravel(), U.ravel(), T.ravel())
        every.append((X.reshape(*U.shape, 3), n.reshape(*U.shape, 3), U, T, on))
    X, N, U, T, suction = (np.concatenate(a, axis=1) for a in zip(*every, strict=True))
    wide = X.shape[1]
    parts = [(X.reshape(-1, 3), N.reshape(-1, 3), AIRFOIL)]
    faces = [strips(rows, wide)]
    ring_t, ring_s = T[0], suction[0]
    if stand is not None:
        rings = stand.chart.out(_resampled(stand.rings[1:], ring_t, ring_s))
        start = rows * wide
        faces.append(strips(2, wide, start - wide))
        faces.append(strips(len(rings), wide, start))
        parts.append((rings.reshape(-1, 3), np.zeros((rings[..., 0].size, 3)), FOOT))
    if tip:
        rings = _resampled(cap(surface), ring_t, ring_s)[1:]
        start = sum(len(p[0]) for p in parts)
        ids = np.concatenate([np.arange(wide), start + np.arange(rings[..., 0].size)])
        faces.append(ids[strips(len(rings) + 1, wide)][:, ::-1])
        parts.append((rings.reshape(-1, 3), np.zeros((rings[..., 0].size, 3)), TIP))
    points = np.concatenate([p[0] for p in parts])
    normals = np.concatenate([p[1] for p in parts])
    kind = np.concatenate([np.full(len(p[0]), p[2]) for p in parts])
    triangles = np.concatenate(faces)
    triangles = triangles if _points_out(points, triangles, N, X) else triangles[:, ::-1]
    more = len(points) - U.size
    nan = np.full(more, np.nan)
    place = (np.concatenate([suction.ravel(), np.zeros(more, bool)]),
             np.concatenate([U.ravel(), nan]), np.concatenate([T.ravel(), nan]))  # fmt: skip
    return points, normals, kind, place, triangles


def _points_out(points, triangles, N, X):
    a, b, c = np.moveaxis(points[triangles[: 2 * X.shape[1]]], 1, 0)
    return np.sum(np.cross(b - a, c - a) * N.reshape(-1, 3)[triangles[: 2 * X.shape[1], 0]]) > 0


def _resampled(rings, t, suction):
    """Loops of `root` at other places t of both sides."""
    own = graded((rings.shape[1] + 2) // 2)
    first, second = rings[:, : len(own)], np.concatenate(
        [rings[:, :1], rings[:, len(own):][:, ::-1], rings[:, len(own) - 1: len(own)]], axis=1
    )  # fmt: skip
    j = np.clip(np.searchsorted(own, t) - 1, 0, len(own) - 2)
    s = ((t - own[j]) / (own[j + 1] - own[j]))[:, None]
    side = np.where(suction[None, :, None], (1 - s) * first[:, j] + s * first[:, j + 1],
                    (1 - s) * second[:, j] + s * second[:, j + 1])  # fmt: skip
    return side
