"""NASA Rotor 37 in seven notations: one blade."""

from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.optimize import least_squares
from scipy.spatial import cKDTree

from bladecad.arrays import Array, Points
from bladecad.data.read import read_sections
from bladecad.data.sections import Sections
from bladecad.errors import DataError


def dense(points: Points, per_gap: int = 40) -> Points:
    """The loop's periodic cubic spline, densely sampled."""
    loop = np.vstack([points, points[:1]])
    t = np.append(0, np.cumsum(np.linalg.norm(np.diff(loop, axis=0), axis=1)))
    fine = np.interp(np.arange(per_gap * len(points)) / per_gap, np.arange(len(t)), t)
    return CubicSpline(t, loop, bc_type="periodic")(fine)


def cut(blade: Sections, x: float) -> Array:
    """Tangential and axial position where the lines of equal index cross the plane of that x."""
    lines = np.array([s.points for s in blade.sections])
    through = CubicSpline(np.arange(len(lines)), lines)
    at = [
        CubicSpline(np.arange(len(lines)), lines[:, j, 0]).solve(x, extrapolate=False)
        for j in range(lines.shape[1])
    ]
    return np.array([through(u[0])[j, 1:] for j, u in enumerate(at)])


def test_the_surface_table_and_its_csv_are_the_same_points(shared_data: Path, fixtures: Path):
    folder = shared_data / "nasa-rotor37"
    table, ours = read_sections(folder / "rotor37geometry.dat"), read_sections(fixtures / "rotor37")
    unnamed = read_sections(folder / "ar355_sections.csv")
    for a, b, c in zip(table.sections, ours.sections, unnamed.sections, strict=True):
        np.testing.assert_allclose(a.points, b.points, rtol=0, atol=3e-5)
        np.testing.assert_array_equal(b.points, c.points)
        assert (a.le, a.te) == (b.le, b.te) == (c.le, c.te) == ((0,), (99,))
        assert (a.suction, b.suction, c.suction) == (None, "first", None)
    np.testing.assert_allclose(table.row.hub, ours.row.hub)
    np.testing.assert_allclose(table.row.shroud, ours.row.shroud)


def test_the_turbogrid_profile_and_the_csv_profiles_are_the_same_points(shared_data: Path):
    folder = shared_data / "nasa-rotor37"
    curve, csv = read_sections(folder / "turbogrid"), read_sections(folder / "csv")
    for a, b in zip(curve.sections, csv.sections, strict=True):
        np.testing.assert_allclose(a.points[:, ::-1], b.points, rtol=0, atol=1e-6)


@pytest.mark.parametrize(
    ("name", "median", "largest"),
    [("turbogrid", 0.13, 0.55), ("Rotor37_Autoblade.geomTurbo", 0.2, 0.65)],
)
def test_the_surface_is_the_same_in_every_notation(
    shared_data: Path, name: str, median: float, largest: float
):
    """As far as they are: each was made anew from the table by its program's own interpolation."""
    folder = shared_data / "nasa-rotor37"
    ours = [dense(s.points, 8) for s in read_sections(folder / "rotor37geometry.dat").sections]
    span = CubicSpline(np.arange(13), np.array(ours))
    theirs = np.vstack([s.points for s in read_sections(folder / name).sections])
    distance = to_surface(theirs, span(np.linspace(0, 12, 241)))
    assert np.median(distance) < median
    assert distance.max() < largest


def test_the_suction_side_is_named_alike(shared_data: Path, fixtures: Path):
    ours = read_sections(fixtures / "rotor37").sections[0]
    theirs = read_sections(shared_data / "nasa-rotor37/Rotor37_Autoblade.geomTurbo").sections[0]
    sides = cKDTree(ours.points[1:99]), cKDTree(ours.points[100:])
    middle = theirs.points[40:80]
    assert np.all(sides[0].query(middle)[0] < sides[1].query(middle)[0])
    assert theirs.suction == ours.suction == "first"


@pytest.mark.parametrize(("k", "untwist"), [(2, 0.0), (4, 0.2), (6, 0.6), (8, 1.0), (9, 1.1)])
def test_the_cold_blade_is_the_hot_one_untwisted(fixtures: Path, k: int, untwist: float):
    """Right way round, right hand, right side: after a rigid fit in the plane, 0.02 mm apart."""
    cold = read_sections(fixtures / "rotor37-cold").sections[k].points
    hot = dense(cut(read_sections(fixtures / "rotor37"), cold[0, 0]))
    moved = fitted(cold[:, 1:], hot)
    distance, _ = cKDTree(hot).query(moved)
    assert np.median(distance) < 0.02
    assert np.quantile(distance, 0.9) < 0.07
    turn = np.degrees(angle(moved[64] - moved[0]) - angle(cold[64, 1:] - cold[0, 1:]))
    assert turn == pytest.approx(-untwist, abs=0.2)
    mirrored = fitted(cold[:, 1:] * [1, -1], hot)
    assert np.median(cKDTree(hot).query(mirrored)[0]) > 5 * np.median(distance)


def test_the_edges_of_the_cold_blade_are_the_stated_circles(fixtures: Path):
    blade = read_sections(fixtures / "rotor37-cold")
    for section, r_le in ((blade.sections[0], 0.0099 * 25.4), (blade.sections[11], 0.0052 * 25.4)):
        edge = section.points[np.arange(-11, 12), 1:]
        centre = centre_of(edge)
        np.testing.assert_allclose(np.linalg.norm(edge - centre, axis=1), r_le, rtol=1e-6)


def test_a_manufacturing_table_without_its_fellow_asks_for_it(fixtures: Path, tmp_path: Path):
    file = tmp_path / "tp1337_points.csv"
    file.write_text((fixtures / "rotor37-cold" / "tp1337_points.csv").read_text())
    with pytest.raises(DataError, match=r"its fellow, a table with columns section, radius, r_le"):
        read_sections(file)


def fitted(points: Array, curve: Array) -> Array:
    tree = cKDTree(curve)

    def moved(p: Array) -> Array:
        c, s = np.cos(p[0]), np.sin(p[0])
        return (points - points.mean(0)) @ np.array([[c, s], [-s, c]]) + p[1:]

    start = np.append(0, curve.mean(0))
    fit = least_squares(
        lambda p: tree.query(moved(p))[0], start, loss="soft_l1", f_scale=0.01, diff_step=1e-6
    )
    return moved(fit.x)


def angle(v: Array) -> float:
    return float(np.arctan2(v[0], v[1]))


def centre_of(arc: Array) -> Array:
    """Centre of the circle through points: |p|^2 = 2 c.p + const."""
    lines = np.column_stack([2 * arc, np.ones(len(arc))])
    return np.linalg.lstsq(lines, (arc**2).sum(axis=1))[0][:2]


def to_surface(points: Points, grid: Array) -> Array:
    """Distance to the tangent plane at the nearest node of a grid of points."""
    u, t = np.gradient(grid, axis=(0, 1))
    normal = np.cross(u, t).reshape(-1, 3)
    _, nearest = cKDTree(grid.reshape(-1, 3)).query(points)
    unit = normal[nearest] / np.linalg.norm(normal[nearest], axis=1, keepdims=True)
    return np.abs(np.einsum("ij,ij->i", points - grid.reshape(-1, 3)[nearest], unit))
