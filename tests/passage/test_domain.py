from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from bladecad.errors import DataError, GeometryError, ToleranceError
from bladecad.fit.sidefit import SideFit
from bladecad.meshes.named import NamedMesh
from bladecad.passage.cylinder import to_cylinder
from bladecad.passage.row import full_row
from bladecad.pipeline.passage import passage_of
from bladecad.pipeline.passage_settings import PassageSettings
from bladecad.surface.blade import BladeSurface
from tests.passage.made import COUNT, HUB, SHROUD, A, line, metal, prism, row, standing

COARSE = PassageSettings(inlet=20.0, outlet=25.0, size=5.0, chord_error=0.05)
OUTER = {"inlet", "outlet", "hub", "shroud", "periodic_1", "periodic_2"}
BLADE = {"blade_suction", "blade_pressure", "blade_le", "blade_te"}


@cache
def passage_about(axis=2):
    return passage_of(row(axis), COARSE)


def witness(gap=0.0):
    """Volume of the fluid from closed forms alone: cylinders, and the prism between them."""
    return np.pi * (SHROUD**2 - HUB**2) * (2 * A + 45.0) / COUNT - metal(gap)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_passage_is_closed_periodic_and_has_its_volume_about_any_axis(axis):
    passage = passage_about(axis)
    mesh = passage.mesh
    assert set(mesh.patches) == OUTER | BLADE
    assert mesh.open_edges == 0
    assert mesh.volume == pytest.approx(witness(), rel=1e-4)
    assert passage.volume == pytest.approx(witness(), rel=1e-9)
    turn = Rotation.from_rotvec(2 * np.pi / COUNT * np.eye(3)[axis])
    first, second = (mesh.vertices[ids] for ids in passage.twins.T)
    assert np.abs(turn.apply(first) - second).max() < 1e-9
    assert set(passage.twins[:, 0]) == set(mesh.patches["periodic_1"].ravel())
    assert set(passage.twins[:, 1]) == set(mesh.patches["periodic_2"].ravel())
    assert passage.period_error < 1e-9
    assert passage.chord_error <= 0.05


def test_both_periodic_faces_are_made_of_the_same_triangles():
    passage = passage_about()
    place = np.zeros(len(passage.mesh.vertices), dtype=int)
    place[passage.twins[:, 0]] = place[passage.twins[:, 1]] = np.arange(len(passage.twins))
    first, second = (place[passage.mesh.patches[f"periodic_{k}"]] for k in (1, 2))
    sets = [{frozenset(t) for t in k.tolist()} for k in (first, second)]
    assert sets[0] == sets[1]


def test_patches_look_out_of_the_fluid():
    mesh = passage_about().mesh
    for name, side in (("hub", -1.0), ("shroud", 1.0)):
        a, b, c = np.moveaxis(mesh.vertices[mesh.patches[name]], 1, 0)
        out = np.einsum("kx,kx->k", np.cross(b - a, c - a)[:, :2], a[:, :2])
        assert np.all(side * out > 0.0)
    a, b, c = np.moveaxis(mesh.vertices[mesh.patches["inlet"]], 1, 0)
    assert np.all(np.cross(b - a, c - a)[:, 2] < 0.0)


def test_gaps_at_the_tip_and_at_the_hub_are_fluid():
    made = {}
    for which, name in (("tip_gap", "blade_tip"), ("hub_gap", "blade_hub")):
        mesh = made[which] = passage_of(row(), replace(COARSE, **{which: 0.7})).mesh
        assert set(mesh.patches) == OUTER | BLADE | {name}
        assert mesh.open_edges == 0
        r = np.linalg.norm(mesh.vertices[np.unique(mesh.patches[name])][:, :2], axis=1)
        wall = SHROUD - 0.7 if which == "tip_gap" else HUB + 0.7
        np.testing.assert_allclose(r, wall, atol=1e-9)
    assert made["tip_gap"].volume == pytest.approx(witness(0.7), rel=1e-4)


def test_triangles_keep_a_narrow_gap_open():
    """Chords of the shroud come inwards; asked for 0.05 mm they would be in the metal."""
    passage = passage_of(row(), replace(COARSE, size=8.0, tip_gap=0.05))
    X, patches = passage.mesh.vertices, passage.mesh.patches
    middles = X[patches["shroud"]].mean(axis=1)
    lowest = np.linalg.norm(middles[:, :2], axis=1).min()
    assert passage.chord_error <= 0.01
    assert lowest > SHROUD - 0.02
    assert passage.mesh.open_edges == 0


@pytest.mark.parametrize("gap", [0.0, 0.7])
def test_a_blunt_edge_has_its_face(gap):
    blade = replace(row(), surface=prism(te="blunt"))
    passage = passage_of(blade, replace(COARSE, tip_gap=gap))
    assert passage.mesh.open_edges == 0
    assert "blade_te" in passage.mesh.patches
    k = passage.mesh.patches["blade_te"]
    z = passage.mesh.vertices[np.unique(k), 2]
    np.testing.assert_allclose(z, -A * np.cos(0.97 * np.pi), atol=1e-9)
    assert passage.volume_error < 1e-4


def test_walls_from_outlet_to_inlet_are_turned():
    backward = row(hub=line(HUB)[::-1], shroud=line(SHROUD)[::-1])
    passage = passage_of(backward, COARSE)
    z = to_cylinder(passage.mesh.vertices[np.unique(passage.mesh.patches["inlet"])], 2)[:, 0]
    np.testing.assert_allclose(z, -A - 20.0, atol=1e-9)


def test_inlet_and_outlet_are_where_they_are_asked_or_where_the_walls_end():
    short = row(hub=line(HUB, 20.0), shroud=line(SHROUD, 20.0))
    passage = passage_of(short, replace(COARSE, inlet=None, outlet=3.0))
    X, patches = passage.mesh.vertices, passage.mesh.patches
    np.testing.assert_allclose(X[np.unique(patches["inlet"]), 2], -20.0, atol=1e-9)
    np.testing.assert_allclose(X[np.unique(patches["outlet"]), 2], A + 3.0, atol=1e-9)
    assert "the hub ends 8 mm from the leading edge" in passage.notes[0]


def test_the_row_is_closed_and_holds_all_passages():
    passage = passage_about()
    whole = full_row(passage)
    assert set(whole.patches) == set(passage.mesh.patches) - {"periodic_1", "periodic_2"}
    assert whole.open_edges == 0
    assert whole.volume == pytest.approx(COUNT * passage.mesh.volume, rel=1e-12)
    assert len(np.unique(whole.vertices.round(9), axis=0)) == len(whole.vertices)


def test_the_place_inside_is_in_the_fluid():
    passage = passage_about()
    assert _winding(passage.mesh, passage.inside) == pytest.approx(1.0, abs=1e-6)


def _winding(mesh: NamedMesh, place) -> float:
    """Solid angle of the surface over 4 pi (van Oosterom and Strackee, 1983)."""
    a, b, c = np.moveaxis(mesh.vertices[mesh.triangles] - place, 1, 0)
    la, lb, lc = (np.linalg.norm(x, axis=1) for x in (a, b, c))
    dots = [np.einsum("kx,kx->k", p, q) for p, q in ((a, b), (b, c), (c, a))]
    top = np.einsum("kx,kx->k", a, np.cross(b, c))
    bottom = la * lb * lc + dots[0] * lc + dots[1] * la + dots[2] * lb
    return float(np.sum(2.0 * np.arctan2(top, bottom)) / (4.0 * np.pi))


@pytest.mark.parametrize(
    ("blade", "asked", "error", "said"),
    [
        (row(count=None), {}, DataError, "how many blades the row has; give --blades"),
        (row(hub=np.empty((0, 2))), {}, DataError, "nothing of hub and shroud.*--walls"),
        (row(hub=line(SHROUD), shroud=line(HUB)), {}, DataError, "hub is above the shroud"),
        (row(hub=line(HUB + 80), shroud=line(SHROUD + 80)), {}, DataError, "does not cross"),
        (row(count=200), {}, GeometryError, "crosses its periodic face by .* look at the blade"),
        (row(), {"inlet": 80.0}, DataError, "reaches 48 mm beyond the leading edge, 80 mm are"),
    ],
)
def test_what_makes_no_passage_is_refused(blade, asked, error, said):
    with pytest.raises(error, match=said):
        passage_of(blade, replace(COARSE, **asked))


@pytest.mark.parametrize(
    "asked", [{"tip_gap": -0.1}, {"hub_gap": np.nan}, {"inlet": 0.0}, {"blades": 1}]
)
def test_settings_that_make_no_sense_are_refused(asked):
    with pytest.raises(ToleranceError, match="asked"):
        PassageSettings(**asked)


def bowed(by):
    """The prism, its middle moved upstream."""
    blade = row()
    sides = []
    for side in (blade.surface.suction, blade.surface.pressure):
        middle = side.coefficients.mean(axis=0)
        middle[2, 2] -= by
        low, high = side.coefficients
        sides.append(SideFit(side.bases, np.stack([low, middle, high])))
    return standing(blade, surface=BladeSurface(np.array([0.0, 0.5, 1.0]), *sides))


def test_a_blade_that_bows_out_of_the_inlet_is_refused():
    found = passage_of(bowed(6.0), COARSE)
    assert _winding(found.mesh, found.inside) == pytest.approx(1.0, abs=1e-6)
    with pytest.raises(GeometryError, match=r"larger --inlet"):
        passage_of(bowed(6.0), replace(COARSE, inlet=1.0))


def test_a_row_of_more_triangles_than_anyone_writes_is_refused(monkeypatch):
    monkeypatch.setattr("bladecad.passage.row.LARGEST", 1000)
    with pytest.raises(GeometryError, match=r"24 passages take .* triangles, 1,000 at most"):
        full_row(passage_about())
