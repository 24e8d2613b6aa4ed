import numpy as np
import pytest

from bladecad.errors import DataError
from bladecad.passage.cylinder import from_cylinder, to_cylinder, turned
from bladecad.passage.read_walls import walls_of
from bladecad.passage.walls import turned_round, walls
from tests.passage.made import line

RNG = np.random.default_rng(7)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_cylindrical_coordinates_go_both_ways_and_turn(axis):
    points = RNG.normal(size=(50, 3)) * 100
    zrt = to_cylinder(points, axis, 0.4)
    np.testing.assert_allclose(from_cylinder(zrt, axis), points, atol=1e-12)
    assert np.abs(zrt[:, 2] - 0.4).max() <= np.pi
    further = to_cylinder(turned(points, axis, 0.1), axis, 0.4)
    away = np.remainder(further[:, 2] - zrt[:, 2] - 0.1 + np.pi, 2 * np.pi) - np.pi
    assert np.abs(away).max() < 1e-13


def test_heights_over_a_cone_are_those_of_its_line():
    z = np.linspace(0, 100, 9)
    above = np.column_stack([z, np.full(9, 200.0)])
    hub, shroud = walls(np.column_stack([z, 50 + 0.2 * z]), above)
    points = np.column_stack([RNG.uniform(20, 80, 99), RNG.uniform(40, 190, 99)])
    height, s = hub.height(points)
    n = np.array([-0.2, 1.0]) / np.hypot(0.2, 1.0)
    np.testing.assert_allclose(height, (points - [0.0, 50.0]) @ n, atol=1e-10)
    np.testing.assert_allclose(shroud.height(points)[0], 200.0 - points[:, 1], atol=1e-10)
    np.testing.assert_allclose(hub.above(s, 3.0), hub(s) + 3.0 * n, atol=1e-10)
    np.testing.assert_allclose(turned_round(hub).height(points)[0], height, atol=1e-10)


def test_nearest_places_of_a_bent_wall_are_nearer_than_all_others():
    a = np.linspace(0.0, np.pi / 2, 30)  # an axial inlet that turns radial
    hub, _ = walls(
        np.column_stack([100 * np.sin(a), 150 - 100 * np.cos(a)]),
        np.column_stack([60 * np.sin(a), 150 - 60 * np.cos(a)]),
    )
    points = np.column_stack([RNG.uniform(5, 60, 60), RNG.uniform(60, 140, 60)])
    own = np.linalg.norm(hub(hub.nearest(points)) - points, axis=1)
    dense = hub(np.linspace(0, hub.nodes[-1], 20001))
    least = np.linalg.norm(dense[None] - points[:, None], axis=2).min(axis=1)
    assert np.all(own <= least + 1e-12)
    assert (least - own).max() < 0.01  # as far apart as the dense places


def test_points_given_twice_are_one():
    hub, _ = walls(np.repeat(line(100.0), 2, axis=0), line(150.0))
    assert len(hub.points) == 7


@pytest.mark.parametrize(
    ("hub", "shroud", "said"),
    [
        (line(150.0), line(100.0), "hub is above the shroud: radius 150 mm against 100 mm"),
        (line(100.0)[:1], line(150.0), "the hub has 1 point, 2 are needed"),
        (line(100.0), np.empty((0, 2)), "the shroud has no points"),
        (line(-5.0), line(150.0), "radius of -5 mm"),
    ],
)
def test_walls_that_are_none_are_refused(hub, shroud, said):
    with pytest.raises(DataError, match=said):
        walls(hub, shroud)


def test_walls_are_read_from_a_table_and_in_its_unit(tmp_path):
    file = tmp_path / "walls.csv"
    rows = [f"{name},{z},{r}" for name, r in (("hub", 10), ("shroud", 15)) for z in (0, 2, 4)]
    file.write_text("\n".join(["curve,z_cm,r_cm", *rows]))
    row = walls_of(file)
    np.testing.assert_allclose(row.hub, [[0, 100], [20, 100], [40, 100]])
    np.testing.assert_allclose(row.shroud[:, 1], 150)


def test_walls_are_read_as_the_blade_reads_them(fixtures, shared_data):
    own = walls_of(fixtures / "rotor37" / "hub_shroud.csv")
    assert len(own.hub) == 31
    assert len(own.shroud) == 32
    inf = next((shared_data / "hannover-4ac-front").rglob("*.inf"))
    assert walls_of(inf).blade_count is not None


def test_a_file_without_walls_is_refused(fixtures):
    with pytest.raises(DataError, match="has no hub"):
        walls_of(fixtures / "broken" / "good.csv")


def channel(legs: int, bend: int, radius: float) -> np.ndarray:
    """From axial to radial: a quarter turn about (0, 150) and straight legs, 200 mm each."""
    angle, way = np.linspace(0.0, 0.5 * np.pi, bend), np.linspace(0.0, 1.0, legs + 1)[:-1, None]
    turn = np.column_stack([radius * np.sin(angle), 150.0 - radius * np.cos(angle)])
    ahead, behind = turn[0] + (way - 1.0) * [200.0, 0.0], turn[-1] + (1.0 - way[::-1]) * [0.0, 200]
    return np.concatenate([ahead, turn, behind])


def test_the_fluid_is_between_the_walls_however_close_their_points_stand():
    """Points that crowd in the shroud's bend draw its mean to the other side of the hub's."""
    hub, shroud = walls(channel(10, 10, 100.0), channel(2, 30, 80.0))
    assert (hub.side, shroud.side) == (1.0, -1.0)
