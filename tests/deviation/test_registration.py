"""Registration: a moved blade comes back, from anywhere, and what is no such blade is refused."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.stats import chi2

from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.deviation.registering.pose import FREEDOMS, free_of, motions, moved, pose, stepped
from bladecad.deviation.registering.registration import apply, register
from bladecad.errors import DataError, ToleranceError
from bladecad.fit.sidefit import SideFit
from bladecad.surface.loft import graded
from tests.deviation.scanned import blade, normals_at

FAR = 3000.0  # mm


@pytest.fixture(scope="module")
def nominal():
    return nominal_of(blade())


def scanned(count=1500, *, u=(0.0, 1.0), t=(0.0, 1.0), sides=("suction", "pressure"), seed=0):
    """Points and normals, spread over the sides as a scanner would, and their u."""
    rng = np.random.default_rng(seed)
    surface, parts = blade(), []
    for side in sides:
        k = count // len(sides)
        uu, tt = rng.uniform(*u, k), rng.uniform(*t, k)
        parts.append((surface.at(side, uu, tt), normals_at(surface, side, uu, tt), uu))
    return tuple(np.concatenate(p) for p in zip(*parts, strict=True))


def anywhere(seed):
    rng = np.random.default_rng(seed)
    return pose(Rotation.from_quat(rng.normal(size=4)).as_matrix(), rng.uniform(-FAR, FAR, 3))


def error(found, moved_by):
    """Largest distance, mm, of any place of the blade from where it belongs, and angle in deg."""
    surface, ends = blade(), np.linspace(0, 1, 5)
    X = np.concatenate(
        [surface(s, ends, graded(9)).reshape(-1, 3) for s in ("suction", "pressure")]
    )
    E = found.T_nominal_scan @ moved_by
    angle = np.linalg.norm(Rotation.from_matrix(E[:3, :3]).as_rotvec())
    return np.linalg.norm(moved(E, X) - X, axis=1).max(), np.degrees(angle)


@pytest.mark.parametrize("seed", range(6))
def test_a_moved_blade_is_registered_back_from_anywhere(nominal, seed):
    points, _, _ = scanned(seed=seed)
    T = anywhere(seed)
    found = register(nominal, moved(T, points))
    away, angle = error(found, T)
    assert away < 1e-5  # mm; a hundredth of what is asked
    assert angle < 1e-5  # degrees
    assert found.rms < 1e-6
    assert found.notes == ()
    np.testing.assert_allclose(apply(found, moved(T, points)), points, atol=1e-5)


@pytest.mark.parametrize("about", range(3))
def test_hub_and_tip_or_the_sides_exchanged_are_put_right(nominal, about):
    points, _, _ = scanned()
    c = points.mean(axis=0)
    axes = np.linalg.svd(points - c, full_matrices=False)[2]
    R = Rotation.from_rotvec(np.pi * axes[about]).as_matrix()
    T = pose(R, c - R @ c)
    assert error(register(nominal, moved(T, points)), T)[0] < 1e-5


PARTS = {
    "suction side": {"sides": ("suction",)},
    "pressure side": {"sides": ("pressure",)},
    "hub half": {"u": (0.0, 0.5)},
    "tip half": {"u": (0.5, 1.0)},
    "middle third": {"u": (0.33, 0.66)},
    "no edges": {"t": (0.1, 0.9)},
    "front half": {"t": (0.0, 0.5)},
}


@pytest.mark.parametrize("part", PARTS)
def test_a_scan_of_a_part_is_registered_back_from_anywhere(nominal, part):
    points, _, _ = scanned(1200, **PARTS[part])
    T = anywhere(len(part))
    found = register(nominal, moved(T, points))
    assert error(found, T)[0] < 1e-3
    said = " ".join(found.notes)
    assert ("one-sided" in said) == ("side" in part)
    assert ("covers the span only" in said) == (
        "half" in part or "third" in part
    ) or "front" in part


def with_root(points, seed=0):
    """A block below the hub, as many points as the blade has half."""
    rng = np.random.default_rng(seed)
    k = len(points) // 2
    box = rng.uniform(-1, 1, (k, 3))
    box[np.arange(k), rng.integers(0, 3, k)] = rng.choice([-1.0, 1.0], k)
    low, high = points.min(axis=0), points.max(axis=0)
    middle, half = 0.5 * (low + high), 0.6 * (high - low)
    return np.concatenate([points, middle + box * half - [high[0] - low[0], 0, 0] * np.array(1.1)])


def test_root_and_platform_are_left_out_and_said_so(nominal):
    points, _, _ = scanned()
    T = anywhere(4)
    found = register(nominal, moved(T, with_root(points)))
    assert error(found, T)[0] < 1e-5
    assert found.beyond + found.far >= 0.95 * len(points) // 2
    assert "did not count" in found.notes[0]


def test_registering_a_moved_scan_is_registering_and_moving_back(nominal):
    """With noise, too: the pose turns with the scan."""
    points, _, _ = scanned()
    points = points + np.random.default_rng(8).normal(0, 0.02, points.shape)
    T = anywhere(7)
    here, there = register(nominal, points), register(nominal, moved(T, points))
    placed = moved(here.T_nominal_scan, points)
    np.testing.assert_allclose(moved(there.T_nominal_scan @ T, points), placed, atol=2e-4)
    np.testing.assert_allclose(there.deviations, here.deviations, rtol=0.01)
    assert there.rms == pytest.approx(here.rms, rel=1e-4)


def test_the_covariance_predicts_the_scatter_of_the_pose(nominal):
    """Over repeats e^T C^-1 e sums to chi-square with 6 degrees of freedom a repeat."""
    repeats, sigma = 16, 0.01
    points, normals, _ = scanned(800)
    rng, total = np.random.default_rng(3), 0.0
    for _ in range(repeats):
        noisy = points + rng.normal(0, sigma, len(points))[:, None] * normals
        found = register(nominal, noisy)
        T = np.linalg.inv(found.T_nominal_scan)  # where truth lies, seen from the pose found
        turn = Rotation.from_matrix(T[:3, :3]).as_rotvec()
        e = np.concatenate([moved(T, found.centre[None])[0] - found.centre, turn])
        total += e @ np.linalg.solve(found.covariance, e)
    low, high = chi2.ppf([1e-4, 1 - 1e-4], 6 * repeats)
    # The sandwich of 800 points is itself known to some per cent: 10 % on either side.
    assert 0.9 * low < total < 1.1 * high


def test_gross_outliers_do_not_move_the_blade(nominal):
    points, _, _ = scanned()
    rng = np.random.default_rng(5)
    points = points + rng.normal(0, 0.005, points.shape)
    spoilt = points.copy()
    k = rng.choice(len(points), len(points) // 20, replace=False)
    spoilt[k] += rng.normal(0, 5.0, (len(k), 3))
    clean, rough = register(nominal, points), register(nominal, spoilt)
    e = error(rough, np.linalg.inv(clean.T_nominal_scan))[0]
    plain = 5.0 * np.sqrt(0.05) * np.linalg.norm(clean.deviations[:3]) / clean.scale
    assert e < 3 * np.linalg.norm(clean.deviations[:3]) < 0.05 * plain
    assert rough.scale == pytest.approx(clean.scale, rel=0.15)


def test_a_bump_moves_the_pose_less_than_least_squares_would(nominal):
    points, normals, u = scanned()
    bump = 0.2 * np.exp(-(((u - 0.6) / 0.1) ** 2)) * (np.arange(len(u)) < len(u) // 2)
    found = register(nominal, points + bump[:, None] * normals)
    J = np.column_stack([normals, np.cross(points - found.centre, normals)])
    pulled = np.linalg.lstsq(J, bump, rcond=None)[0]
    assert np.linalg.norm(pulled[:3]) > 0.02  # mm: least squares goes along
    assert error(found, np.eye(4))[0] < 0.1 * np.linalg.norm(pulled[:3])
    placed = apply(found, points + bump[:, None] * normals)
    assert np.einsum("kx,kx->k", placed - points, normals).max() == pytest.approx(0.2, abs=0.01)


@pytest.mark.parametrize("locked", [("x",), ("z", "rx"), ("x", "y", "z"), ("rx", "ry", "rz")])
def test_locked_coordinates_do_not_move_and_the_others_are_found(nominal, locked):
    points, _, _ = scanned(seed=2)
    free = free_of(locked)
    q = np.where(free, [1.5, -2.0, 1.0, 0.03, 0.02, -0.04], 0.0)[free]
    T = stepped(np.eye(4), free, q)  # the pose to be found
    found = register(nominal, moved(np.linalg.inv(T), points), locked=locked)
    np.testing.assert_allclose(found.T_nominal_scan, T, atol=1e-6)
    placed = np.concatenate([found.T_nominal_scan[:3, 3], found.rotation])
    assert (placed[~free] == 0.0).all()
    assert found.locked == tuple(n for n in FREEDOMS if n in locked)
    C = found.covariance
    assert np.linalg.matrix_rank(C, tol=1e-9 * np.linalg.norm(C)) <= free.sum()


def test_a_rotation_of_any_size_about_the_free_axis_is_found_with_the_rest_locked(nominal):
    points, _, _ = scanned()
    T = pose(Rotation.from_rotvec([0.0, 0.0, 2.4]).as_matrix(), np.array([300.0, -200.0, 0.0]))
    found = register(nominal, moved(np.linalg.inv(T), points), locked=("z", "rx", "ry"))
    np.testing.assert_allclose(found.T_nominal_scan, T, atol=1e-6)


def test_motions_are_the_derivative_of_the_pose():
    """Of every coordinate, by differences; shift at the centre and rotation."""
    T, centre, h = anywhere(3), np.array([20.0, -5.0, 7.0]), 1e-6
    B = motions(T, centre, free_of(()))
    X, Y = np.eye(3)[:2]
    body = moved(np.linalg.inv(T), np.stack([centre, centre + X, centre + Y]))
    for j in range(6):
        step = h * np.eye(6)[j]
        a, b = (moved(stepped(T, free_of(()), s * step), body) for s in (-1, 1))
        speed = (b - a) / (2 * h)
        shift, turn = B[:3, j], B[3:, j]
        arms = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
        np.testing.assert_allclose(speed, shift + np.cross(turn, arms), atol=1e-4)


def test_taken_as_it_stands_nothing_moves(nominal):
    points, normals, _ = scanned()
    found = register(nominal, points + 0.05 * normals, fit="none")
    assert (found.T_nominal_scan == np.eye(4)).all()
    assert (found.steps, found.angle, found.kind) == (0, 0.0, "none")
    assert found.rms == pytest.approx(0.05, abs=1e-3)
    with pytest.raises(DataError, match="register it with --fit best"):
        register(nominal, points + 200.0, fit="none")


def test_what_was_absorbed_is_told_at_the_centre(nominal):
    points, _, _ = scanned()
    turn = Rotation.from_rotvec([0.0, 0.02, 0.0]).as_matrix()
    c = register(nominal, points).centre
    found = register(nominal, moved(pose(turn, c - turn @ c + [0.0, 0.3, 0.0]), points))
    np.testing.assert_allclose(found.shift, [0.0, -0.3, 0.0], atol=1e-5)
    np.testing.assert_allclose(found.rotation, [0.0, -0.02, 0.0], atol=1e-7)
    assert found.angle == pytest.approx(0.02, abs=1e-7)


@pytest.mark.parametrize(
    ("factor", "said"),
    [
        (1 / 25.4, r"0\.0\d+ times .* multiplied by 25\.4: they are inches.*--units in"),
        (25.4, r"divided by 25\.4: they are mm, not inches; give --units mm"),
        (1e-3, r"multiplied by 1000: they are metres.*--units m\b"),
        (0.1, r"centimetres.*--units cm"),
        (10.0, r"mm, not centimetres"),
        (1 / 304.8, r"feet.*--units ft"),
        (7.0, r"^the scan is 7(\.0\d*)? times .*; 0\.7\d* times when .* a scan of this blade"),
        (0.94, r"another size: made 1\.06\d times"),
    ],
)
def test_another_unit_or_size_is_named(nominal, factor, said):
    points, _, _ = scanned()
    with pytest.raises(DataError, match=said):
        register(nominal, factor * moved(anywhere(1), points))


def test_a_scan_that_shrank_a_little_is_told_so(nominal):
    points, _, _ = scanned()
    found = register(nominal, 0.995 * points)
    assert "1.0050 times as large" in found.notes[0]


@pytest.mark.parametrize("root", [False, True])
def test_a_mirrored_scan_is_named(nominal, root):
    points, _, _ = scanned()
    points = with_root(points) if root else points
    with pytest.raises(DataError, match="the scan is mirrored"):
        register(nominal, moved(anywhere(2), points * [1.0, -1.0, 1.0]))


def test_another_blade_is_refused_with_its_residual_and_a_bad_one_is_not(nominal):
    """Bent by 4 % of the chord at the tip it is this blade; with twice the camber it is not."""
    points, _, u = scanned()
    chord = np.ptp(points, axis=0)[1:].max()
    axis = np.cross([1.0, 0.0, 0.0], np.linalg.svd(points - points.mean(0))[2][0])
    axis = axis / np.linalg.norm(axis)
    bent = points + (0.04 * chord * u**2)[:, None] * axis
    found = register(nominal, bent)
    assert found.scale < 0.003 * chord
    assert "check that it is this blade" in found.notes[0]
    flat = points - points.mean(axis=0)
    V = np.linalg.svd(flat, full_matrices=False)[2]
    other = flat @ V.T * [1.0, 1.0, 1.7] + np.outer((flat @ V[1]) ** 2 / chord, [0, 0, 0.5])
    with pytest.raises(DataError, match=r"another blade: at best .* mm \(robust\) .* is allowed"):
        register(nominal, other)


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda X: X[:20], "20 points, 50 are needed"),
        (lambda X: X * [1, 0, 0], "on one line"),
        (lambda X: X * [1, 1, 0], "on one plane"),
        (lambda X: 0 * X, "at one place"),
        (lambda X: np.where(np.arange(len(X))[:, None] == 3, np.nan, X), "1 points .* not finite"),
    ],
)
def test_few_flat_or_broken_clouds_are_refused(nominal, spoil, said):
    points, _, _ = scanned()
    with pytest.raises(DataError, match=said):
        register(nominal, spoil(points))


def test_a_pose_that_slides_is_refused_and_its_direction_told():
    """A blade of one section all along: nothing says where it stands along the span."""
    surface = blade()
    suction, pressure = extruded(surface.suction), extruded(surface.pressure)
    straight = replace(surface, suction=suction, pressure=pressure)
    rng = np.random.default_rng(0)
    points = np.concatenate(
        [straight.at(s, rng.random(600), rng.random(600)) for s in ("suction", "pressure")]
    )
    with pytest.raises(DataError, match=r"not determined: a shift along \(-?1\.00, .* lock x"):
        register(nominal_of(straight), points)
    held = register(nominal_of(straight), points, locked=("x",))
    assert held.rms < 1e-6


def extruded(side):
    """The first section again and again, 17.5 mm higher each time."""
    basis, C = side.bases[0], side.coefficients
    up = np.arange(len(C))[:, None, None] * basis.one[None, :, None] * [17.5, 0.0, 0.0]
    return SideFit((basis,), C[0] + up)


def test_unknown_or_all_locked_coordinates_are_refused(nominal):
    points, _, _ = scanned()
    with pytest.raises(ToleranceError, match='"u" cannot be locked; one of x, y, z'):
        register(nominal, points, locked=("u",))
    with pytest.raises(ToleranceError, match="all six"):
        register(nominal, points, locked=FREEDOMS)
