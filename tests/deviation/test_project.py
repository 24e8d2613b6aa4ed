"""Distances to a blade surface: against brute force, with their sign, on every kind of face."""

from dataclasses import replace

import numpy as np
import pytest

from bladecad.curves.sides import split_sides
from bladecad.data.synthetic import synthetic_blade
from bladecad.deviation.inspecting.measure import measure
from bladecad.deviation.nearest.nominal import nominal_of
from bladecad.deviation.nearest.project import project
from bladecad.deviation.nearest.referee import confirm
from bladecad.errors import GeometryError
from bladecad.fit.blade import Order
from bladecad.pipeline import Settings, fit, surface_of
from bladecad.surface.blade import normals
from bladecad.surface.triangulate import triangulate

SIDES = ("suction", "pressure")
U, T = np.linspace(0.1, 0.9, 9), np.array([0.001, 0.01, 0.1, 0.35, 0.6, 0.9, 0.99, 0.999])


def blade(**kind):
    sections = synthetic_blade(5, 80, **kind)
    settings = Settings(order=Order(2, 2, 9), tolerance=0.05)
    return sections, surface_of(fit(split_sides(sections), settings))


@pytest.fixture(scope="module")
def round_blade():
    sections, surface = blade()
    return sections, surface, triangulate(surface, chord_error=0.005)


@pytest.fixture(scope="module")
def blunt_blade():
    sections, surface = blade(trailing_edge="blunt")
    return sections, surface, triangulate(surface, chord_error=0.005)


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("d", [0.2, 0.01, -0.01, -0.05])
def test_a_point_offset_by_d_along_the_normal_stands_at_d(round_blade, side, d):
    _, surface, _mesh = round_blade
    points = surface(side, U, T) + d * normals(surface, side, U, T)
    feet = project(nominal_of(surface), points.reshape(-1, 3))
    assert np.abs(feet.distance - d).max() < 1e-9


def test_feet_are_the_nearest_places_of_a_dense_search(round_blade):
    _, surface, _mesh = round_blade
    rng = np.random.default_rng(5)
    on = surface.at("pressure", rng.random(40), rng.random(40))
    points = on + rng.normal(0, 0.5, (40, 3))
    feet = project(nominal_of(surface), points)
    u, t = np.linspace(0, 1, 801), np.linspace(0, 1, 1601)
    for side in SIDES:
        grid = surface(side, u, t).reshape(-1, 3)
        brute = np.array([np.linalg.norm(grid - p, axis=1).min() for p in points])
        assert (np.abs(feet.distance) <= brute + 1e-9).all()


def test_points_on_the_face_of_a_cut_off_edge_lie_on_the_blade(blunt_blade):
    _, surface, _mesh = blunt_blade
    u, v = np.linspace(0, 1, 7), np.array([0.2, 0.5, 0.8])[:, None, None]
    one = np.ones(1)
    S, P = (surface(s, u, one)[:, 0] for s in SIDES)
    inside = (S + v * (P - S)).reshape(-1, 3)
    assert np.abs(project(nominal_of(surface), inside).distance).max() < 1e-9
    along = surface("suction", u, one, 0, 1)[:, 0]
    out = along / np.linalg.norm(along, axis=1)[:, None]
    beyond = (S + 0.5 * (P - S)) + 0.05 * out
    away = project(nominal_of(surface), beyond).distance
    assert (away > 0.03).all()
    assert (away <= 0.05 + 1e-9).all()


def test_trimesh_agrees_within_the_chord_error(round_blade):
    sections, surface, mesh = round_blade
    referee = measure(surface, mesh, sections).referee
    assert referee.count == sum(len(s.points) for s in sections.sections)
    assert 0 < referee.disagreement <= referee.bound


def test_the_referee_refuses_distances_that_are_not_those_of_the_blade(round_blade):
    sections, surface, mesh = round_blade
    points = sections.sections[2].points
    feet = project(nominal_of(surface), points)
    wrong = replace(feet, foot=feet.foot + 0.02 * feet.normal)
    with pytest.raises(GeometryError, match="trimesh measures point"):
        confirm(mesh, points, wrong)


def test_points_set_aside_are_measured_but_do_not_count(round_blade):
    sections, surface, mesh = round_blade
    spoilt = sections.sections[1].points.copy()
    spoilt[20] += [0.0, 0.0, 1.0]
    moved = type(sections.sections[1])("2", spoilt)
    bad = type(sections)(
        (sections.sections[0], moved, *sections.sections[2:]), sections.source, sections.row
    )
    keep = [np.ones(len(s.points), bool) for s in bad.sections]
    counted = measure(surface, mesh, bad, keep)
    assert counted.worst() == (counted.names[1], 20)
    keep[1][20] = False
    aside = measure(surface, mesh, bad, keep)
    assert aside.largest < 0.05 < counted.largest
    assert aside.set_aside.sum() == 1


def test_the_rows_of_the_table_add_up(round_blade):
    sections, surface, mesh = round_blade
    found = measure(surface, mesh, sections)
    rows = {row.name: row for row in found.table()}
    assert rows["suction side"].points + rows["pressure side"].points == rows["all"].points
    by_section = [row for name, row in rows.items() if name.startswith("section")]
    assert sum(row.points for row in by_section) == rows["all"].points
    assert max(row.largest for row in by_section) == rows["all"].largest == found.largest
