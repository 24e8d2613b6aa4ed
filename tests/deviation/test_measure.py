"""The whole blade measured: a blade offset by d deviates from itself by d, sign included."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from bladecad.curves.sides import split_sides
from bladecad.data.sections import Section, Sections, Source
from bladecad.data.synthetic import synthetic_blade
from bladecad.deviation.inspecting.measure import EDGE_ZONE, measure
from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.deviation.nearest.project import project
from bladecad.deviation.nearest.squares import EXACT
from bladecad.fit.blade import Order
from bladecad.pipeline import Settings, fit, surface_of
from bladecad.surface.blade import normals
from bladecad.surface.loft import graded
from bladecad.surface.triangulate import triangulate

SIDES = ("suction", "pressure")


@pytest.fixture(scope="module", params=["round", "blunt"])
def blade(request):
    sections = synthetic_blade(5, 80, trailing_edge=request.param)
    settings = Settings(order=Order(2, 2, 9), tolerance=0.05)
    surface = surface_of(fit(split_sides(sections), settings))
    return surface, triangulate(surface, chord_error=0.002)


def offset(surface, d, count=41):
    """Sections whose points stand d off the blade along its normals, at u off the ends."""
    u, t = np.linspace(0.1, 0.9, 5), graded(count)
    t = t[t < 0.99] if surface.te == "blunt" else t  # beyond, the face of the cut is nearer
    loops = np.concatenate(
        [
            surface("suction", u, t) + d * normals(surface, "suction", u, t),
            (surface("pressure", u, t) + d * normals(surface, "pressure", u, t))[:, ::-1],
        ],
        axis=1,
    )
    sections = tuple(Section(f"{i}", loop) for i, loop in enumerate(loops))
    return Sections(sections, Source(None, "offset"))


@pytest.mark.parametrize("d", [0.5, 0.02, -0.02, -0.06])
def test_a_blade_offset_by_d_deviates_by_d_in_every_row(blade, d):
    surface, mesh = blade
    found = measure(surface, mesh, offset(surface, d))
    np.testing.assert_allclose(found.distance, d, atol=1e-7)
    for row in found.table():
        assert row.points > 0
        assert (row.largest, row.p99, row.rms) == pytest.approx((abs(d),) * 3, abs=1e-7)
        assert row.mean == pytest.approx(d, abs=1e-7)
    assert found.referee.disagreement <= found.referee.bound


def test_outside_is_positive_and_the_opposite_of_trimeshs_sign(blade):
    surface, mesh = blade
    body = trimesh.Trimesh(mesh.vertices, mesh.triangles, process=False)
    rng = np.random.default_rng(7)
    u, t = rng.uniform(0.2, 0.8, 60), rng.uniform(0.05, 0.9, 60)
    for d in (0.3, -0.3):
        n = np.array([normals(surface, "suction", u[k : k + 1], t[k : k + 1])[0, 0]
                      for k in range(60)])  # fmt: skip
        points = surface.at("suction", u, t) + d * n
        mine = project(nominal_of(surface), points).distance
        theirs = trimesh.proximity.signed_distance(body, points)
        np.testing.assert_allclose(theirs, -mine, atol=2 * mesh.chord_error)
        assert (np.sign(mine) == np.sign(d)).all()


@pytest.mark.parametrize("away", [0.01, 0.3, 3.0, 13.0])
def test_no_place_of_the_blade_is_nearer_than_the_foot(blade, away):
    """A dense search over sides and faces of cut-off edges, refined about its best."""
    surface, _mesh = blade
    rng = np.random.default_rng(3)
    on = np.concatenate(
        [surface.at(s, rng.random(20), graded(2001)[rng.integers(0, 2001, 20)]) for s in SIDES]
    )
    step = rng.normal(size=on.shape)
    points = on + away * step / np.linalg.norm(step, axis=1, keepdims=True)
    feet = project(nominal_of(surface), points)
    u, t = np.linspace(0, 1, 201), graded(601)
    for side in SIDES:
        grid = surface(side, u, t).reshape(-1, 3)
        nearest = np.array([((grid - p) ** 2).sum(axis=1).min() for p in points])
        assert (np.abs(feet.distance) <= np.sqrt(nearest) + 1e-9).all()
    at_foot = np.where(
        feet.suction[:, None],
        surface.at("suction", feet.u, feet.t),
        surface.at("pressure", feet.u, feet.t),
    )
    straight = np.linalg.norm(points - at_foot, axis=1)
    on_side = (feet.t > 0) & (feet.t < 1)
    gap = np.abs(feet.distance)[on_side] - straight[on_side]
    held = (feet.u[on_side] <= 0) | (feet.u[on_side] >= 1)  # measured along the normal
    assert np.abs(gap[~held]).max() < 2 * EXACT
    if away >= 3.0:  # nearer, the exactness of the squares can be more than that share of it
        assert (np.abs(gap) <= 1e-9 * straight[on_side])[~held].all()
    assert (gap[held] < 2 * EXACT).all()


def test_the_foot_is_where_the_normal_meets_the_point(blade):
    surface, _mesh = blade
    rng = np.random.default_rng(11)
    u, t = rng.uniform(0.1, 0.9, 50), rng.uniform(0.02, 0.97, 50)
    for s in SIDES:
        points = np.array(
            [
                surface(s, u[k : k + 1], t[k : k + 1])[0, 0]
                + 0.01 * normals(surface, s, u[k : k + 1], t[k : k + 1])[0, 0]
                for k in range(50)
            ]
        )
        feet = project(nominal_of(surface), points)
        np.testing.assert_allclose(feet.u, u, atol=1e-6)
        np.testing.assert_allclose(feet.t, t, atol=1e-6)
        assert (feet.suction == (s == "suction")).all()


def test_rows_are_the_statistics_of_their_points(blade):
    surface, mesh = blade
    blades = offset(surface, 0.0)
    rng = np.random.default_rng(2)
    moved = tuple(
        replace(s, points=s.points + rng.normal(0, 0.01, s.points.shape)) for s in blades.sections
    )
    found = measure(surface, mesh, replace(blades, sections=moved))
    rows = {row.name: row for row in found.table()}
    groups = {
        "all": np.ones(len(found.t), bool),
        "leading edge": found.t < EDGE_ZONE,
        "trailing edge": found.t > 1 - EDGE_ZONE,
        "suction side": found.suction,
        'section "3"': found.section == 3,
    }
    for name, group in groups.items():
        d, row = found.distance[group], rows[name]
        assert row.points == len(d)
        assert row.largest == np.abs(d).max()
        assert row.rms == pytest.approx(np.sqrt((d**2).mean()))
        assert row.mean == pytest.approx(d.mean())
        assert row.p99 <= row.largest
    name, index = found.worst()
    k = int(np.abs(found.distance).argmax())
    assert (name, index) == (found.names[found.section[k]], found.index[k])
    assert rows["all"].rms == pytest.approx(0.01, rel=0.1)


def test_moving_blade_and_points_together_changes_no_distance(blade):
    surface, _mesh = blade
    shift = np.array([1000.0, -500.0, 300.0])

    def moved(side):
        one = side.bases[0].one[:, None] * shift
        return replace(side, coefficients=side.coefficients + one)

    far = replace(surface, suction=moved(surface.suction), pressure=moved(surface.pressure))
    points = np.concatenate([s.points for s in offset(surface, 0.05).sections])
    here = project(nominal_of(surface), points)
    there = project(nominal_of(far), points + shift)
    np.testing.assert_allclose(there.distance, here.distance, atol=1e-8)
