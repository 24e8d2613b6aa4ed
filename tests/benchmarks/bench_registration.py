"""How long a registration takes, and how well it ends; run by `make bench`."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from threadpoolctl import threadpool_limits

from bladecad.curves.sides import split_sides
from bladecad.data.synthetic import synthetic_blade
from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.deviation.nearest.project import project
from bladecad.deviation.registering.pose import moved, pose
from bladecad.deviation.registering.registration import register
from bladecad.deviation.sectioning.section_fit import fits_of
from bladecad.fit.blade import Order
from bladecad.pipeline import Settings, fit, surface_of
from bladecad.surface.loft import SIDES, graded

MILLION = 1_000_000


@pytest.fixture(scope="module")
def surface():
    with threadpool_limits(1):
        lines = split_sides(synthetic_blade(13, 120))
        return surface_of(fit(lines, Settings(order=Order(3, 3, 13), tolerance=0.05)))


@pytest.fixture(scope="module")
def nominal(surface):
    nominal = nominal_of(surface)
    project(nominal, surface("suction", np.linspace(0, 1, 5), np.linspace(0, 1, 5)).reshape(-1, 3))
    return nominal


@pytest.fixture(scope="module")
def scan(surface):
    rng = np.random.default_rng(0)
    return np.concatenate(
        [surface.at(s, rng.random(MILLION // 2), rng.random(MILLION // 2)) for s in SIDES]
    )


@pytest.mark.parametrize("noise", [0.0, 0.01])
def test_a_million_points_from_an_arbitrary_pose(benchmark, nominal, surface, scan, noise):
    rng = np.random.default_rng(1)
    T = pose(Rotation.from_quat(rng.normal(size=4)).as_matrix(), rng.uniform(-3e3, 3e3, 3))
    points = moved(T, scan + rng.normal(0, 1, scan.shape) * noise)
    found = benchmark.pedantic(register, (nominal, points), rounds=3, warmup_rounds=1)
    E = found.T_nominal_scan @ T
    ends = np.linspace(0, 1, 9)
    X = np.concatenate([surface(s, ends, graded(33)).reshape(-1, 3) for s in SIDES])
    away = np.linalg.norm(moved(E, X) - X, axis=1).max()
    angle = np.degrees(np.linalg.norm(Rotation.from_matrix(E[:3, :3]).as_rotvec()))
    benchmark.extra_info["micrometres"] = round(1e3 * away, 4)
    benchmark.extra_info["degrees"] = round(angle, 7)
    benchmark.extra_info["projected"] = found.projected
    assert away <= 1e-3
    assert angle <= 1e-3
    assert found.projected <= 2.5 * MILLION
    assert benchmark.stats.stats.median <= 5.0


def test_the_million_points_are_projected_once(benchmark, nominal, scan):
    """What the registration is to be compared with."""
    benchmark.pedantic(project, (nominal, scan), rounds=3, warmup_rounds=1)


def test_half_a_blade_from_an_arbitrary_pose(benchmark, nominal, scan):
    half = scan[scan[:, 0] < np.median(scan[:, 0])]
    T = pose(Rotation.from_rotvec([1.0, 2.0, -1.5]).as_matrix(), np.full(3, 500.0))
    found = benchmark.pedantic(register, (nominal, moved(T, half)), rounds=1)
    assert found.rms < 1e-6
    assert benchmark.stats.stats.median <= 5.0


def test_four_fits_of_one_section(benchmark, surface):
    t = graded(200)
    sides = [surface(s, np.array([0.5]), t)[0, :, 1:] for s in SIDES]
    loop = np.concatenate([sides[0], sides[1][-2:0:-1]])
    T = np.roll(loop, -1, axis=0) - np.roll(loop, 1, axis=0)
    n = np.column_stack([T[:, 1], -T[:, 0]]) / np.linalg.norm(T, axis=1, keepdims=True)
    n *= np.sign(np.einsum("nx,nx->", loop - loop.mean(axis=0), n))
    d = 0.02 * np.sin(np.linspace(0, 20, len(loop)))
    found = benchmark.pedantic(fits_of, (loop, n, d), rounds=3)
    assert len(found) == 4
